/* Copying elements from one type to another. */
#ifndef COSIM_NATIVE_CONVERT_H
#define COSIM_NATIVE_CONVERT_H

#include "plan.h"

/* Carry out one CONVERT operation. */
void convert(const Operation *operation);

#endif
