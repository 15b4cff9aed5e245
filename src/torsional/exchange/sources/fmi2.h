/* FMI 2.0 for co-simulation.  The interface is declared here after the standard, so that nothing else is needed. */
#include <stdarg.h>

#ifdef _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

#ifdef WITH_FMI_HEADERS /* those of the standard, against which this file can be checked */
#include "fmi2Functions.h"
#else
typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
#endif

typedef struct {
    Machine *machine;
    const fmi2CallbackFunctions *callbacks;
    char name[256];
    double start;
    bool begun;
} Instance;

#define OF(c) ((Instance *)(c))

static fmi2Status told(Instance *c, fmi2Status status, const char *words)
{
    if (c && c->callbacks && c->callbacks->logger)
        c->callbacks->logger(c->callbacks->componentEnvironment, c->name, status, "logStatusError", "%s", words);
    return status;
}

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }

EXPORTED fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi2OK;
}

EXPORTED fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                       const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    Instance *c = calloc(1, sizeof(Instance));
    if (!c) return NULL;
    c->callbacks = callbacks;
    snprintf(c->name, sizeof c->name, "%s", name ? name : "");
    const char *wrong = NULL;
    if (type != fmi2CoSimulation) wrong = "this unit is for co-simulation";
    else if (!token || strcmp(token, TOKEN) != 0) wrong = "the guid is not that of the model description";
    else if (!(c->machine = machine_new())) wrong = "there is not enough memory";
    if (wrong) {
        told(c, fmi2Error, wrong);
        free(c);
        return NULL;
    }
    return c;
}

EXPORTED void fmi2FreeInstance(fmi2Component c)
{
    if (!c) return;
    machine_free(OF(c)->machine);
    free(c);
}

EXPORTED fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real start,
                                        fmi2Boolean stops, fmi2Real stop)
{
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    OF(c)->start = start;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    int status = machine_begin(OF(c)->machine, OF(c)->start);
    OF(c)->begun = true;
    return status == MACHINE_DONE ? fmi2OK : told(OF(c), fmi2Error, machine_words[status]);
}

EXPORTED fmi2Status fmi2Terminate(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2Reset(fmi2Component c)
{
    machine_reset(OF(c)->machine);
    OF(c)->begun = false;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[])
{
    for (size_t k = 0; k < n; k++)
        if (!machine_get(OF(c)->machine, vr[k], &value[k])) return told(OF(c), fmi2Error, "no such variable");
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[])
{
    for (size_t k = 0; k < n; k++) {
        if (OF(c)->begun && vr[k] >= INPUTS)
            return told(OF(c), fmi2Error, "parameters are set before the initialisation ends, outputs never");
        if (!machine_set(OF(c)->machine, vr[k], value[k]))
            return told(OF(c), fmi2Error, "no such input or parameter, or a number that it cannot have");
    }
    return fmi2OK;
}

#define NO_VALUES(KIND, TYPE)                                                                                         \
    EXPORTED fmi2Status fmi2Get##KIND(fmi2Component c, const fmi2ValueReference vr[], size_t n, TYPE value[])         \
    {                                                                                                                 \
        (void)vr, (void)value;                                                                                        \
        return n ? told(OF(c), fmi2Error, "all variables are real") : fmi2OK;                                         \
    }                                                                                                                 \
    EXPORTED fmi2Status fmi2Set##KIND(fmi2Component c, const fmi2ValueReference vr[], size_t n, const TYPE value[])   \
    {                                                                                                                 \
        (void)vr, (void)value;                                                                                        \
        return n ? told(OF(c), fmi2Error, "all variables are real") : fmi2OK;                                         \
    }
NO_VALUES(Integer, fmi2Integer)
NO_VALUES(Boolean, fmi2Boolean)
NO_VALUES(String, fmi2String)

#define FMI(name) fmi2##name
#define STATE(before, after) fmi2##before##FMUstate##after
#define OWNER fmi2Component
#define DESERIALIZE fmi2DeSerializeFMUstate
#include "states.h"

EXPORTED fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz,
                                                 const fmi2ValueReference v[], size_t nv, const fmi2Real dv[],
                                                 fmi2Real dz[])
{
    (void)z, (void)nz, (void)v, (void)nv, (void)dv, (void)dz;
    return told(OF(c), fmi2Error, "directional derivatives are not provided");
}

EXPORTED fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n ? told(OF(c), fmi2Error, "inputs are not interpolated") : fmi2OK;
}

EXPORTED fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                 const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n ? told(OF(c), fmi2Error, "derivatives of outputs are not provided") : fmi2OK;
}

EXPORTED fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean no_set)
{
    (void)no_set;
    if (!(length > 0.0)) return told(OF(c), fmi2Error, "a step takes some time");
    int status = machine_step(OF(c)->machine, time, length);
    return status == MACHINE_DONE ? fmi2OK : told(OF(c), fmi2Error, machine_words[status]);
}

EXPORTED fmi2Status fmi2CancelStep(fmi2Component c) { return told(OF(c), fmi2Error, "no step is under way"); }

EXPORTED fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return told(OF(c), fmi2Discard, "steps end before they return");
}

EXPORTED fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime) return told(OF(c), fmi2Discard, "no such status");
    *value = OF(c)->machine->time;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return told(OF(c), fmi2Discard, "no such status");
}

EXPORTED fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated) return told(OF(c), fmi2Discard, "no such status");
    *value = 0;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return told(OF(c), fmi2Discard, "no such status");
}
