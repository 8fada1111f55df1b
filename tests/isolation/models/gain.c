/* A library of the same name beside two FMUs, with another number in each. */
double gain(void) { return GAIN; }
