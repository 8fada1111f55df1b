/* Rows of recorded variables as comma-separated text. */
#include <stdbool.h>
#include <string.h>

#include "decimal.h"
#include "plan.h"

typedef struct {
    const void *values; /* shape (rows, elements) */
    size_t elements;
    int64_t type;
} Column;

static char *write_element(char *text, const Column *column, size_t index, const uint64_t *powers)
{
    const void *values = column->values;
    switch (column->type) {
    case FLOAT64: return write_double(text, ((const double *)values)[index], powers);
    case FLOAT32: return write_double(text, (double)((const float *)values)[index], powers);
    case INT8: return write_signed(text, ((const int8_t *)values)[index]);
    case UINT8: return write_unsigned(text, ((const uint8_t *)values)[index]);
    case INT16: return write_signed(text, ((const int16_t *)values)[index]);
    case UINT16: return write_unsigned(text, ((const uint16_t *)values)[index]);
    case INT32: return write_signed(text, ((const int32_t *)values)[index]);
    case UINT32: return write_unsigned(text, ((const uint32_t *)values)[index]);
    case INT64: return write_signed(text, ((const int64_t *)values)[index]);
    case UINT64: return write_unsigned(text, ((const uint64_t *)values)[index]);
    default: return write_unsigned(text, ((const bool *)values)[index]);
    }
}

/* Format rows *row to `stop`, as many as surely fit into `capacity` bytes; advances *row.
 *
 * Returns the number of bytes written.
 */
EXPORT size_t cosim_format_rows(const Column *columns, size_t count, const uint64_t *powers, size_t *row, size_t stop,
                                char *text, size_t capacity)
{
    size_t longest = 0;
    for (size_t i = 0; i < count; ++i) {
        longest += columns[i].elements * (LONGEST_NUMBER + 1);
    }
    char *const begin = text, *const end = text + capacity;
    while (*row < stop && (size_t)(end - text) >= longest) {
        for (size_t i = 0; i < count; ++i) {
            for (size_t j = 0; j < columns[i].elements; ++j) {
                text = write_element(text, columns + i, *row * columns[i].elements + j, powers);
                *text++ = ',';
            }
        }
        text[-1] = '\n';
        *row += 1;
    }
    return (size_t)(text - begin);
}
