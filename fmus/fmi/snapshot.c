/* Saved states: a header and all values, in one block that is also the serialised form. */
#include <stdlib.h>
#include <string.h>

#include "instance.h"

#define MAGIC UINT64_C(0x464d55534e415031)  /* also tells the byte order */

struct Snapshot {
    uint64_t magic;
    uint64_t size;       /* of the whole block [byte] */
    uint64_t coils;
    uint32_t mode;
    uint32_t interface;
    double stop_time;
    char token[TOKEN_SIZE];
    double values[];
};

size_t snapshot_size(const Snapshot *snapshot)
{
    return (size_t)snapshot->size;
}

Status snapshot_take(Instance *instance, Snapshot **snapshot)
{
    const size_t bytes = instance->model.length * sizeof(double);
    const size_t size = sizeof(Snapshot) + bytes;
    Snapshot *taken = *snapshot; /* FMI allows to overwrite a state taken before */
    if (taken == NULL || taken->size != size) {
        taken = realloc(taken, size);
        if (taken == NULL) {
            return instance_refuse(instance, "out of memory");
        }
    }
    memset(taken, 0, sizeof *taken);
    taken->magic = MAGIC;
    taken->size = size;
    taken->coils = instance->model.coils;
    taken->mode = instance->mode;
    taken->interface = instance->interface;
    taken->stop_time = instance->stop_time;
    instantiation_token(instance->fmi_version, taken->token);
    memcpy(taken->values, instance->model.values, bytes);
    *snapshot = taken;
    return STATUS_OK;
}

Status snapshot_restore(Instance *instance, const Snapshot *snapshot)
{
    if (snapshot == NULL) {
        return instance_refuse(instance, "there is no saved state to restore");
    }
    if (snapshot->interface != (uint32_t)instance->interface) {
        return instance_refuse(instance, "the saved state belongs to the other interface (Co-Simulation or Model "
                                         "Exchange)");
    }
    if (snapshot->coils != instance->model.coils && instance_resize(instance, (double)snapshot->coils) != STATUS_OK) {
        return STATUS_ERROR;
    }
    memcpy(instance->model.values, snapshot->values, instance->model.length * sizeof(double));
    instance->mode = (Mode)snapshot->mode;
    instance->stop_time = snapshot->stop_time;
    instance->is_stale = true;
    return STATUS_OK;
}

/* Whether a mode is one single bit of Mode. */
static bool is_mode(uint32_t mode)
{
    return mode != 0 && mode <= MODE_FAILED && (mode & (mode - 1)) == 0;
}

Status snapshot_read(Instance *instance, const void *bytes, size_t size, Snapshot **snapshot)
{
    Snapshot header;
    if (bytes == NULL || size < sizeof header) {
        return instance_refuse(instance, "%zu bytes are no saved state", size);
    }
    memcpy(&header, bytes, sizeof header);
    char token[TOKEN_SIZE] = "";
    instantiation_token(instance->fmi_version, token);
    size_t length = 0;
    for (size_t i = 0; i < VARIABLE_COUNT && header.coils <= MAXIMUM_COILS; i++) {
        length += variable_size(&model_variables[i], (size_t)header.coils);
    }
    if (header.magic != MAGIC || memcmp(header.token, token, strlen(token) + 1) != 0) {
        return instance_refuse(instance, "the saved state was made by another model, version or machine");
    }
    if (header.coils < MINIMUM_COILS || header.coils > MAXIMUM_COILS || header.size != size || !is_mode(header.mode) ||
        size != sizeof header + length * sizeof(double)) {
        return instance_refuse(instance, "the saved state is damaged");
    }
    Snapshot *copy = realloc(*snapshot, size);
    if (copy == NULL) {
        return instance_refuse(instance, "out of memory");
    }
    memcpy(copy, bytes, size);
    *snapshot = copy;
    return STATUS_OK;
}
