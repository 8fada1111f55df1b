/* FMI 2.0: saved states. */
#include "fmi2Functions.h"

#include <stdlib.h>
#include <string.h>

#include "instance.h"

static fmi2Status as_fmi2(Status status)
{
    return status == STATUS_OK ? fmi2OK : fmi2Error;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    Snapshot *snapshot = *FMUstate;
    const Status status = snapshot_take(c, &snapshot);
    *FMUstate = snapshot;
    return as_fmi2(status);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    return as_fmi2(snapshot_restore(c, FMUstate));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    (void)c;
    free(*FMUstate);
    *FMUstate = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    if (FMUstate == NULL) {
        return as_fmi2(instance_refuse(c, "%s: there is no saved state", __func__));
    }
    *size = snapshot_size(FMUstate);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    if (FMUstate == NULL || size < snapshot_size(FMUstate)) {
        return as_fmi2(instance_refuse(c, "%s: no saved state, or %zu bytes are too few", __func__, size));
    }
    memcpy(serializedState, FMUstate, snapshot_size(FMUstate));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate)
{
    Snapshot *snapshot = *FMUstate;
    const Status status = snapshot_read(c, serializedState, size, &snapshot);
    *FMUstate = snapshot;
    return as_fmi2(status);
}
