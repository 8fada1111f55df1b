#include "variables.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) \
    {name, ROLE_##role, extent, unit, start, limit, nominal, depends, description},
const Variable model_variables[VARIABLE_COUNT] = {VARIABLES(V)};
#undef V

size_t variable_size(const Variable *variable, size_t coils)
{
    return variable->extent == PER_COIL ? coils : 1;
}

size_t role_count(Role role)
{
    size_t count = 0;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        count += model_variables[i].role == role;
    }
    return count;
}

size_t role_member(Role role, size_t rank)
{
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == role && rank-- == 0) {
            return i;
        }
    }
    return VARIABLE_COUNT;
}

/* FNV-1a, 64 bit (Fowler, Noll, Vo; RFC 9923). */
static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (; *text != '\0'; text++) {
        hash = (hash ^ (unsigned char)*text) * UINT64_C(1099511628211);
    }
    return hash;
}

void instantiation_token(int fmi_version, char *token)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    char numbers[96];
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        const Variable *v = &model_variables[i];
        snprintf(numbers, sizeof numbers, "|%d|%d|%d|%.17g|%.17g|", (int)v->role, (int)v->extent, (int)v->limit,
                 v->start, v->nominal);
        hash = hash_text(hash, v->name);
        hash = hash_text(hash, v->unit);
        hash = hash_text(hash, numbers);
    }
    snprintf(token, TOKEN_SIZE, "%s-fmi%d-n%d-%016" PRIx64, MODEL_IDENTIFIER, fmi_version, (int)COILS, hash);
}
