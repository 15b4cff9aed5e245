/** Logarithmic limits of colours: the largest value within full load, and a two-hundredth of it or the smallest. */
export function limits(values: ArrayLike<number>, within: ArrayLike<number>): [number, number] {
  let [low, high] = [Infinity, 0];
  for (let i = 0; i < values.length; i++) {
    if (!(values[i] > 0) || !within[i % within.length]) continue;
    low = Math.min(low, values[i]);
    high = Math.max(high, values[i]);
  }
  return high > 0 ? [Math.max(low, high / 200) * 0.999, high] : [0.1, 1];
}
