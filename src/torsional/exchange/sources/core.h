/* One instance: its memory, its variables, its steps.  What is generated stands in front: the translated functions, the
   type Machine with its binding, the tables image_*, start_*, input_*, port_*, parameter_*, output_*. */
#include <stdio.h>
#include <string.h>

enum { RATE_ROW = 1, ACCELERATION_ROW = 2, OWN_ROW = 3, BASE_STEPS_PLACE = 5 };
enum { MACHINE_DONE = 0, MACHINE_NOT_FINITE = 3 };

static const char *const machine_words[] = {
    "done",
    "the torques of a step did not come to agree with its motion; take a smaller step",
    "a stiffness, a damping or an inertia is negative",
    "the motion grew beyond all numbers; take a smaller step",
};

static void machine_reset(Machine *m)
{
    memcpy(m->d, image_d, sizeof image_d);
    memcpy(m->i, image_i, sizeof image_i);
    memcpy(m->given, start_value, sizeof start_value);
    m->time = 0.0;
}

static Machine *machine_new(void)
{
    Machine *m = calloc(1, sizeof(Machine));
    if (!m) return NULL;
    m->d = malloc(sizeof image_d);
    m->i = malloc(sizeof image_i);
    if (!m->d || !m->i) {
        free(m->d);
        free(m->i);
        free(m);
        return NULL;
    }
    machine_bind(m);
    machine_reset(m);
    return m;
}

static void machine_free(Machine *m)
{
    if (!m) return;
    free(m->d);
    free(m->i);
    free(m);
}

/* What an instance is at a moment: numbers alone, so that any instance takes it. */
#define STATE_BYTES (sizeof image_d + sizeof image_i + sizeof start_value + sizeof(double))

static void machine_save(const Machine *m, char *to)
{
    memcpy(to, m->d, sizeof image_d);
    to += sizeof image_d;
    memcpy(to, m->i, sizeof image_i);
    to += sizeof image_i;
    memcpy(to, m->given, sizeof start_value);
    to += sizeof start_value;
    memcpy(to, &m->time, sizeof m->time);
}

static void machine_load(Machine *m, const char *from)
{
    memcpy(m->d, from, sizeof image_d);
    from += sizeof image_d;
    memcpy(m->i, from, sizeof image_i);
    from += sizeof image_i;
    memcpy(m->given, from, sizeof start_value);
    from += sizeof start_value;
    memcpy(&m->time, from, sizeof m->time);
}

/* Values by number: inputs, then parameters, then outputs; false where there is none. */
static bool machine_get(const Machine *m, uint32_t number, double *value)
{
    if (number < GIVEN) {
        *value = m->given[number];
        return true;
    }
    number -= GIVEN;
    if (number >= OUTPUTS) return false;
    *value = 0.0;
    for (int64_t k = output_start[number]; k < output_start[number + 1]; k++) {
        int64_t place = output_of[k];
        double part;
        if (place < 6 * COORDINATES) part = m->state.coordinates.p[place];
        else if ((place -= 6 * COORDINATES) < CONNECTIONS) {
            part = m->state.connection.p[2 * m->state.connection.n[1] + place];
            for (int64_t l = 0; l < m->state.law.n[1]; l++)
                if (m->plan.laws.places.p[l] == place) part += m->state.law.p[l];
        } else part = m->state.reference.p[place - CONNECTIONS];
        *value += output_weight[k] * part;
    }
    return true;
}

static bool machine_set(Machine *m, uint32_t number, double value)
{
    if (number >= GIVEN || !isfinite(value) || (number == STEP && !(value > 0.0))) return false;
    m->given[number] = value;
    return true;
}

static void machine_apply_parameters(Machine *m)
{
    for (int64_t p = 0; p < PARAMETERS; p++)
        for (int64_t k = parameter_start[p]; k < parameter_start[p + 1]; k++)
            m->d[parameter_place[k]] = image_d[parameter_place[k]];
    for (int64_t p = 0; p < PARAMETERS; p++) {
        double more = m->given[INPUTS + p] - start_value[INPUTS + p];
        for (int64_t k = parameter_start[p]; k < parameter_start[p + 1]; k++)
            m->d[parameter_place[k]] += parameter_weight[k] * more;
    }
}

/* Inputs: torques into the levels of their sources; sides take the motion that follows from the inputs at ``after``,
   such that the step of h that ends there predicts it. */
static void machine_apply_inputs(Machine *m, double after, double h)
{
    (void)after;
    (void)h;
#if PORTS
    double *q = m->state.coordinates.p;
    for (int64_t k = 0; k < PORTS; k++) {
        int64_t at = port_coordinate[k];
        double angle = m->given[3 * k], rate = m->given[3 * k + 1], more = m->given[3 * k + 2];
        double end = rate + more * after;
        angle += rate * after + 0.5 * more * after * after;
        q[RATE_ROW * COORDINATES + at] = end - more * h;
        q[at] = angle - h * (end - more * h) - 0.5 * h * h * more;
        q[ACCELERATION_ROW * COORDINATES + at] = q[OWN_ROW * COORDINATES + at] = more;
    }
#else
    for (int64_t k = 0; k < INPUTS; k++) m->d[input_place[k]] = m->given[k];
#endif
}

#if RESTARTS
/* The inverse of the inertia matrix by elimination with pivots; sides do not move by themselves. */
static bool machine_mobility(Machine *m)
{
    enum { N = COORDINATES };
    static const double heavy = 1e30;
    double (*a)[2 * N] = calloc(N, sizeof *a); /* too large for the stack of a thread where bodies are many */
    bool regular = a != NULL;
    if (!regular) return false;
    for (int i = 0; i < N; i++) a[i][i] = m->plan.masses.diagonal.p[i], a[i][N + i] = 1.0;
    for (int64_t k = 0; k < m->plan.masses.above.n[0]; k++) {
        const i2 at = m->plan.masses.above_at;
        a[at.p[k]][at.p[at.n[1] + k]] = a[at.p[at.n[1] + k]][at.p[k]] = m->plan.masses.above.p[k];
    }
#if PORTS
    for (int64_t k = 0; k < PORTS; k++) a[port_coordinate[k]][port_coordinate[k]] = heavy;
#else
    (void)heavy;
#endif
    for (int c = 0; c < N && regular; c++) {
        int best = c;
        for (int r = c + 1; r < N; r++)
            if (fabs(a[r][c]) > fabs(a[best][c])) best = r;
        regular = fabs(a[best][c]) > 0.0;
        for (int k = 0; k < 2 * N; k++) {
            double held = a[c][k];
            a[c][k] = a[best][k];
            a[best][k] = held;
        }
        double pivot = a[c][c];
        for (int k = 0; k < 2 * N; k++) a[c][k] /= pivot;
        for (int r = 0; r < N; r++) {
            double share = a[r][c];
            if (r == c || share == 0.0) continue;
            for (int k = 0; k < 2 * N; k++) a[r][k] -= share * a[c][k];
        }
    }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) m->mobility.p[i * N + j] = a[i][N + j];
    free(a);
    return regular;
}
#endif

/* What is between the sides begins as if it had turned with them, in the middle. */
static void machine_follow(Machine *m)
{
    (void)m;
#if PORTS
    double *q = m->state.coordinates.p;
    for (int64_t row = 0; row < 2; row++)
        for (int64_t i = 0; i < COORDINATES; i++) {
            double mean = 0.0;
            bool side = false;
            for (int64_t k = 0; k < PORTS; k++) {
                mean += q[row * COORDINATES + port_coordinate[k]] / PORTS;
                side = side || port_coordinate[k] == i;
            }
            if (!side) q[row * COORDINATES + i] = mean;
        }
#endif
}

/* The beginning with the inputs and parameters that are set; the state is the exported one where none has changed. */
static int machine_begin(Machine *m, double time)
{
    m->time = time;
    if (!PORTS && memcmp(m->given, start_value, sizeof start_value) == 0) return MACHINE_DONE;
    machine_apply_parameters(m);
    machine_apply_inputs(m, 0.0, 0.0);
    machine_follow(m);
#if RESTARTS
    if (!machine_mobility(m)) return 2;
    k_restart(&m->plan, &m->state, &m->work, m->mobility, m->given[STEP]);
    machine_apply_inputs(m, 0.0, 0.0);
#endif
    return MACHINE_DONE;
}

/* A step of ``length`` from the time t on, as so many equal ones that none is longer than the parameter says. */
static int machine_step(Machine *m, double t, double length)
{
    int64_t steps = (int64_t)ceil(length / m->given[STEP] - 1e-9);
    int status = MACHINE_DONE;
    if (steps < 1) steps = 1;
    double h = length / (double)steps;
    m->state.begin.p[0] = t;
    m->state.counts.p[BASE_STEPS_PLACE] = 0;
#if PORTS
    for (int64_t k = 0; k < steps && status == MACHINE_DONE; k++) {
        machine_apply_inputs(m, (double)(k + 1) * h, h);
        status = (int)k_run(&m->plan, &m->state, &m->work, &m->settings, m->method, h, 1, m->at, &m->records);
    }
#else
    machine_apply_inputs(m, 0.0, h);
    status = (int)k_run(&m->plan, &m->state, &m->work, &m->settings, m->method, h, steps, m->at, &m->records);
#endif
    m->time = t + length;
    for (int64_t k = 0; k < 6 * COORDINATES && status == MACHINE_DONE; k++)
        if (!isfinite(m->state.coordinates.p[k])) status = MACHINE_NOT_FINITE;
    return status;
}
