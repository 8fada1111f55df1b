/* FMI 3.0: saved states. */
#include "fmi3Functions.h"

#include <stdlib.h>
#include <string.h>

#include "instance.h"

static fmi3Status as_fmi3(Status status)
{
    return status == STATUS_OK ? fmi3OK : fmi3Error;
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    Snapshot *snapshot = *FMUState;
    const Status status = snapshot_take(instance, &snapshot);
    *FMUState = snapshot;
    return as_fmi3(status);
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState)
{
    return as_fmi3(snapshot_restore(instance, FMUState));
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    (void)instance;
    free(*FMUState);
    *FMUState = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size)
{
    if (FMUState == NULL) {
        return as_fmi3(instance_refuse(instance, "%s: there is no saved state", __func__));
    }
    *size = snapshot_size(FMUState);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    if (FMUState == NULL || size < snapshot_size(FMUState)) {
        return as_fmi3(instance_refuse(instance, "%s: no saved state, or %zu bytes are too few", __func__, size));
    }
    memcpy(serializedState, FMUState, snapshot_size(FMUState));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[], size_t size,
                                   fmi3FMUState *FMUState)
{
    Snapshot *snapshot = *FMUState;
    const Status status = snapshot_read(instance, serializedState, size, &snapshot);
    *FMUState = snapshot;
    return as_fmi3(status);
}
