/* FMI 3.0 for co-simulation.  The interface is declared here after the standard, so that nothing else is needed. */
#ifdef _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

#ifdef WITH_FMI_HEADERS /* those of the standard, against which this file can be checked */
#include "fmi3Functions.h"
#else
typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef double fmi3Float64;
typedef uint8_t fmi3Byte;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef enum { fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;
typedef void (*fmi3IntermediateUpdateCallback)(void);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);
#endif

typedef struct {
    Machine *machine;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    double start;
    bool begun;
} Instance;

#define OF(c) ((Instance *)(c))

static fmi3Status told(Instance *c, fmi3Status status, const char *words)
{
    if (c && c->log) c->log(c->environment, status, "logStatusError", words);
    return status;
}

EXPORTED const char *fmi3GetVersion(void) { return "3.0"; }

EXPORTED fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

EXPORTED fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                                  fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
                                                  fmi3Boolean early, const fmi3ValueReference between[], size_t n,
                                                  fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                                  fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)between, (void)n;
    (void)update;
    Instance *c = calloc(1, sizeof(Instance));
    if (!c) return NULL;
    c->environment = environment;
    c->log = log;
    const char *wrong = NULL;
    if (!token || strcmp(token, TOKEN) != 0) wrong = "the instantiation token is not that of the model description";
    else if (!(c->machine = machine_new())) wrong = "there is not enough memory";
    if (wrong) {
        told(c, fmi3Error, wrong);
        free(c);
        return NULL;
    }
    return c;
}

EXPORTED fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                   fmi3Boolean visible, fmi3Boolean logging,
                                                   fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    if (log) log(environment, fmi3Error, "logStatusError", "this unit is for co-simulation");
    return NULL;
}

EXPORTED fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                                        fmi3Boolean visible, fmi3Boolean logging,
                                                        fmi3InstanceEnvironment environment,
                                                        fmi3LogMessageCallback log, fmi3ClockUpdateCallback clock,
                                                        fmi3LockPreemptionCallback lock,
                                                        fmi3UnlockPreemptionCallback unlock)
{
    (void)clock, (void)lock, (void)unlock;
    return fmi3InstantiateModelExchange(name, token, resources, visible, logging, environment, log);
}

EXPORTED void fmi3FreeInstance(fmi3Instance c)
{
    if (!c) return;
    machine_free(OF(c)->machine);
    free(c);
}

EXPORTED fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant, fmi3Float64 tolerance,
                                                fmi3Float64 start, fmi3Boolean stops, fmi3Float64 stop)
{
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    OF(c)->start = start;
    OF(c)->machine->time = start;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    int status = machine_begin(OF(c)->machine, OF(c)->start);
    OF(c)->begun = true;
    return status == MACHINE_DONE ? fmi3OK : told(OF(c), fmi3Error, machine_words[status]);
}

#define QUIETLY(NAME)                                                                                                 \
    EXPORTED fmi3Status fmi3##NAME(fmi3Instance c)                                                                    \
    {                                                                                                                 \
        (void)c;                                                                                                      \
        return fmi3OK;                                                                                                \
    }
QUIETLY(Terminate)
QUIETLY(EnterStepMode)

#define REFUSED(NAME, WORDS, ...)                                                                                     \
    EXPORTED fmi3Status fmi3##NAME(__VA_ARGS__) { return told(OF(c), fmi3Error, WORDS); }
#define NO_EVENTS "this unit has no events, clocks or states that are told"
REFUSED(EnterEventMode, NO_EVENTS, fmi3Instance c)
REFUSED(EnterConfigurationMode, "there is nothing to configure", fmi3Instance c)
REFUSED(ExitConfigurationMode, "there is nothing to configure", fmi3Instance c)
REFUSED(EnterContinuousTimeMode, NO_EVENTS, fmi3Instance c)
REFUSED(EvaluateDiscreteStates, NO_EVENTS, fmi3Instance c)

EXPORTED fmi3Status fmi3Reset(fmi3Instance c)
{
    machine_reset(OF(c)->machine);
    OF(c)->begun = false;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 value[],
                                   size_t count)
{
    if (n != count) return told(OF(c), fmi3Error, "as many values as variables are wanted");
    for (size_t k = 0; k < n; k++) {
        if (vr[k] == GIVEN + OUTPUTS) value[k] = OF(c)->machine->time;
        else if (!machine_get(OF(c)->machine, vr[k], &value[k])) return told(OF(c), fmi3Error, "no such variable");
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 value[],
                                   size_t count)
{
    if (n != count) return told(OF(c), fmi3Error, "as many values as variables are wanted");
    for (size_t k = 0; k < n; k++) {
        if (OF(c)->begun && vr[k] >= INPUTS)
            return told(OF(c), fmi3Error, "parameters are set before the initialisation ends, outputs never");
        if (!machine_set(OF(c)->machine, vr[k], value[k]))
            return told(OF(c), fmi3Error, "no such input or parameter, or a number that it cannot have");
    }
    return fmi3OK;
}

#define NO_VALUES(KIND, TYPE)                                                                                         \
    EXPORTED fmi3Status fmi3Get##KIND(fmi3Instance c, const fmi3ValueReference vr[], size_t n, TYPE value[],          \
                                      size_t count)                                                                   \
    {                                                                                                                 \
        (void)vr, (void)value, (void)count;                                                                           \
        return n ? told(OF(c), fmi3Error, "all variables are Float64") : fmi3OK;                                      \
    }                                                                                                                 \
    EXPORTED fmi3Status fmi3Set##KIND(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const TYPE value[],    \
                                      size_t count)                                                                   \
    {                                                                                                                 \
        (void)vr, (void)value, (void)count;                                                                           \
        return n ? told(OF(c), fmi3Error, "all variables are Float64") : fmi3OK;                                      \
    }
NO_VALUES(Float32, float)
NO_VALUES(Int8, int8_t)
NO_VALUES(UInt8, uint8_t)
NO_VALUES(Int16, int16_t)
NO_VALUES(UInt16, uint16_t)
NO_VALUES(Int32, int32_t)
NO_VALUES(UInt32, uint32_t)
NO_VALUES(Int64, int64_t)
NO_VALUES(UInt64, uint64_t)
NO_VALUES(Boolean, fmi3Boolean)
NO_VALUES(String, fmi3String)

EXPORTED fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, size_t sizes[],
                                  const fmi3Byte *value[], size_t count)
{
    (void)vr, (void)sizes, (void)value, (void)count;
    return n ? told(OF(c), fmi3Error, "all variables are Float64") : fmi3OK;
}

EXPORTED fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const size_t sizes[],
                                  const fmi3Byte *const value[], size_t count)
{
    (void)vr, (void)sizes, (void)value, (void)count;
    return n ? told(OF(c), fmi3Error, "all variables are Float64") : fmi3OK;
}

EXPORTED fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, bool value[])
{
    (void)vr, (void)value;
    return n ? told(OF(c), fmi3Error, NO_EVENTS) : fmi3OK;
}

EXPORTED fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const bool value[])
{
    (void)vr, (void)value;
    return n ? told(OF(c), fmi3Error, NO_EVENTS) : fmi3OK;
}

#define NO_DEPENDENCIES "dependencies of variables are those of the model description"
REFUSED(GetNumberOfVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference vr, size_t *n)
REFUSED(GetVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference vr, size_t of[],
        fmi3ValueReference on[], size_t at[], fmi3DependencyKind kinds[], size_t n)

#define FMI(name) fmi3##name
#define STATE(before, after) fmi3##before##FMUState##after
#define OWNER fmi3Instance
#define DESERIALIZE fmi3DeserializeFMUState
#include "states.h"

#define NO_DERIVATIVES "derivatives are not provided"
REFUSED(GetDirectionalDerivative, NO_DERIVATIVES, fmi3Instance c, const fmi3ValueReference z[], size_t nz,
        const fmi3ValueReference v[], size_t nv, const fmi3Float64 seed[], size_t ns, fmi3Float64 out[], size_t no)
REFUSED(GetAdjointDerivative, NO_DERIVATIVES, fmi3Instance c, const fmi3ValueReference z[], size_t nz,
        const fmi3ValueReference v[], size_t nv, const fmi3Float64 seed[], size_t ns, fmi3Float64 out[], size_t no)
REFUSED(GetOutputDerivatives, NO_DERIVATIVES, fmi3Instance c, const fmi3ValueReference vr[], size_t n,
        const int32_t orders[], fmi3Float64 out[], size_t no)
REFUSED(GetIntervalDecimal, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 in[],
        fmi3IntervalQualifier q[])
REFUSED(GetIntervalFraction, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, uint64_t a[],
        uint64_t b[], fmi3IntervalQualifier q[])
REFUSED(GetShiftDecimal, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 shifts[])
REFUSED(GetShiftFraction, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, uint64_t a[],
        uint64_t b[])
REFUSED(SetIntervalDecimal, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 v[])
REFUSED(SetIntervalFraction, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, const uint64_t a[],
        const uint64_t b[])
REFUSED(SetShiftDecimal, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 v[])
REFUSED(SetShiftFraction, NO_EVENTS, fmi3Instance c, const fmi3ValueReference vr[], size_t n, const uint64_t a[],
        const uint64_t b[])
REFUSED(UpdateDiscreteStates, NO_EVENTS, fmi3Instance c, bool *again, bool *ends, bool *nominals, bool *states,
        bool *next, fmi3Float64 *time)
REFUSED(CompletedIntegratorStep, NO_EVENTS, fmi3Instance c, fmi3Boolean no_set, bool *event, bool *ends)
REFUSED(SetTime, NO_EVENTS, fmi3Instance c, fmi3Float64 time)
REFUSED(SetContinuousStates, NO_EVENTS, fmi3Instance c, const fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStateDerivatives, NO_EVENTS, fmi3Instance c, fmi3Float64 x[], size_t n)
REFUSED(GetEventIndicators, NO_EVENTS, fmi3Instance c, fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStates, NO_EVENTS, fmi3Instance c, fmi3Float64 x[], size_t n)
REFUSED(GetNominalsOfContinuousStates, NO_EVENTS, fmi3Instance c, fmi3Float64 x[], size_t n)
REFUSED(GetNumberOfEventIndicators, NO_EVENTS, fmi3Instance c, size_t *n)
REFUSED(GetNumberOfContinuousStates, NO_EVENTS, fmi3Instance c, size_t *n)
REFUSED(ActivateModelPartition, NO_EVENTS, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)

EXPORTED fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 length, fmi3Boolean no_set, bool *event,
                               bool *ends, bool *early, fmi3Float64 *last)
{
    (void)no_set;
    *event = *ends = *early = false;
    *last = OF(c)->machine->time;
    if (!(length > 0.0)) return told(OF(c), fmi3Error, "a step takes some time");
    int status = machine_step(OF(c)->machine, time, length);
    *last = OF(c)->machine->time;
    return status == MACHINE_DONE ? fmi3OK : told(OF(c), fmi3Error, machine_words[status]);
}
