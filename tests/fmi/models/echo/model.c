/* Every output is its input: all types, scalars and arrays whose sizes are structural parameters. Outputs have the value
 * reference of their input plus one. Type by value reference: 10-33 numbers of FMI 3.0's types, 34-37 text and bytes,
 * 40-47 arrays (in FMI 2.0 scalars, up to 59). */
#include <string.h>
#include "plain.h"

const char MODEL_TOKEN[] = "echo";
NO_STATES NO_INDICATORS NO_STEP_EVENTS NO_EVENTS STEP_TO_END

enum { ROWS = 1, COLUMNS = 2, SCALE = 3, HALF = 4, FIRST = 10, LAST = 59, MATRIX = 40, TEXTS = 42, CUBE = 44, WHOLES = 46 };

void model_start(Values *v) {
    v->whole[ROWS][0] = 2; v->whole[COLUMNS][0] = 3; v->number[SCALE][0] = 1.0;
    for (int i = 0; i < ELEMENTS; i++) v->number[HALF][i] = 0.5;
    v->number[50][0] = 1.0; /* z[1] of FMI 2.0 */
    strcpy(v->bytes[34][0], "hello"); v->length[34][0] = 5;
}

size_t model_size(const Values *v, unsigned r) {
    size_t rows = v->whole[ROWS][0], columns = v->whole[COLUMNS][0];
    switch (r & ~1u) {
        case MATRIX: return rows * columns;
        case TEXTS: return rows;
        case CUBE: return rows * columns * 2;
        case WHOLES: return 3;
        default: return r == HALF ? columns : 1;
    }
}

bool model_is_discrete(unsigned r) { return r >= 14 && r < MATRIX; }

void model_outputs(Values *v) {
    for (int r = FIRST; r <= LAST; r += 2) {
        for (int i = 0; i < ELEMENTS; i++) {
            v->number[r + 1][i] = v->number[SCALE][0] * v->number[r][i];
            v->whole[r + 1][i] = v->whole[r][i];
            memcpy(v->bytes[r + 1][i], v->bytes[r][i], BYTES);
            v->length[r + 1][i] = v->length[r][i];
        }
    }
}
