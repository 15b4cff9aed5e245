/* States of a unit kept, restored and written as bytes, the same in FMI 2.0 and 3.0 but for names.  Before it stand
   FMI(name) and STATE(before, after), names of the standard, OWNER, whose states they are, and DESERIALIZE. */
typedef struct {
    bool begun;
    double start;
    char bytes[STATE_BYTES];
} Kept;

EXPORTED FMI(Status) STATE(Get, )(OWNER c, STATE(, ) *state)
{
    Kept *kept = *state ? *state : malloc(sizeof(Kept));
    if (!kept) return told(OF(c), FMI(Error), "there is not enough memory");
    kept->begun = OF(c)->begun;
    kept->start = OF(c)->start;
    machine_save(OF(c)->machine, kept->bytes);
    *state = kept;
    return FMI(OK);
}

EXPORTED FMI(Status) STATE(Set, )(OWNER c, STATE(, ) state)
{
    const Kept *kept = state;
    if (!kept) return told(OF(c), FMI(Error), "no state is given");
    OF(c)->begun = kept->begun;
    OF(c)->start = kept->start;
    machine_load(OF(c)->machine, kept->bytes);
    return FMI(OK);
}

EXPORTED FMI(Status) STATE(Free, )(OWNER c, STATE(, ) *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return FMI(OK);
}

EXPORTED FMI(Status) STATE(Serialized, Size)(OWNER c, STATE(, ) state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(Kept);
    return FMI(OK);
}

EXPORTED FMI(Status) STATE(Serialize, )(OWNER c, STATE(, ) state, FMI(Byte) bytes[], size_t size)
{
    if (size < sizeof(Kept)) return told(OF(c), FMI(Error), "too little room for the state");
    memcpy(bytes, state, sizeof(Kept));
    return FMI(OK);
}

EXPORTED FMI(Status) DESERIALIZE(OWNER c, const FMI(Byte) bytes[], size_t size, STATE(, ) *state)
{
    if (size != sizeof(Kept)) return told(OF(c), FMI(Error), "these are not the bytes of a state");
    if (!*state && !(*state = malloc(sizeof(Kept)))) return told(OF(c), FMI(Error), "there is not enough memory");
    memcpy(*state, bytes, sizeof(Kept));
    return FMI(OK);
}
