/* check_benchmark.h: the benchmark's test of itself. */
#ifndef CHECK_BENCHMARK_H
#define CHECK_BENCHMARK_H

/* Prints what does not hold and the counts; 0 if all holds. `golden` is the directory of the reference tables. */
int check_benchmark(const char *golden);

#endif
