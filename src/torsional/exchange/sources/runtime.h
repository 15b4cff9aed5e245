/* Arrays and arithmetic that translated functions are written in: doubles and whole numbers of 64 bits. */
#ifndef RUNTIME_H
#define RUNTIME_H
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct { double *p; int64_t n[1]; } f1;
typedef struct { double *p; int64_t n[2]; } f2;
typedef struct { double *p; int64_t n[3]; } f3;
typedef struct { int64_t *p; int64_t n[1]; } i1;
typedef struct { int64_t *p; int64_t n[2]; } i2;
typedef struct { int64_t *p; int64_t n[3]; } i3;

static inline double least_double(double a, double b) { return b < a ? b : a; }
static inline double most_double(double a, double b) { return b > a ? b : a; }
static inline int64_t least_int(int64_t a, int64_t b) { return b < a ? b : a; }
static inline int64_t most_int(int64_t a, int64_t b) { return b > a ? b : a; }

/* // and % as Python has them: the rest has the sign of the divisor */
static inline int64_t floor_int(int64_t a, int64_t b) { return a / b - ((a % b != 0) && ((a % b < 0) != (b < 0))); }
static inline int64_t left_int(int64_t a, int64_t b) { return a - b * floor_int(a, b); }
static inline double left_double(double a, double b)
{
    double left = fmod(a, b);
    return left != 0.0 && ((left < 0.0) != (b < 0.0)) ? left + b : left;
}
static inline double floor_double(double a, double b) { return floor((a - left_double(a, b)) / b + 0.5); }

/* x to a whole power by squaring */
static inline double whole_power(double x, int64_t n)
{
    double power = 1.0;
    uint64_t left = n < 0 ? (uint64_t)(-n) : (uint64_t)n;
    while (left) {
        if (left & 1u) power *= x;
        x *= x;
        left >>= 1;
    }
    return n < 0 ? 1.0 / power : power;
}
#endif
