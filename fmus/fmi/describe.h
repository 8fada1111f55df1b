/* The parts of describe.c: each writes XML to standard output. */
#ifndef DESCRIBE_H
#define DESCRIBE_H

/* ModelVariables and ModelStructure. */
void write_variables_fmi2(void);
void write_variables_fmi3(void);

/* One element per source file of the FMU. */
void write_source_files(const char *indent, int version);

#endif
