/* The table of variables and what can be asked of it, shared by the binary and by describe.c. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include <stdint.h>

#include "model.h"

#define TOKEN_SIZE 128

/* Number of values of a variable. */
size_t variable_size(const Variable *variable, size_t coils);

/* Number of variables with a role. */
size_t role_count(Role role);

/* The variable with the given rank (from 0) among those of a role; VARIABLE_COUNT if there is none. */
size_t role_member(Role role, size_t rank);

/* Identifier that changes whenever the table does, so that a binary never meets the description of another.
 * Writes at most TOKEN_SIZE bytes. */
void instantiation_token(int fmi_version, char *token);

#endif
