/* measure.c: times of interleaved methods, as medians over rounds with the 10th and 90th percentile. */
#include "measure.h"

#include <math.h>
#include <microslip.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

entry *entries;
size_t entry_count;
int rounds = 15;
int checks_passed, checks_failed;

static void *blocks[65536];
static size_t block_count;
static volatile double sink;

void require(int32_t status)
{
    if (status != MSLIP_OK) {
        fprintf(stderr, "microslip: %s\n", mslip_status_text(status));
        exit(1);
    }
}

void *allocate(size_t bytes)
{
    const size_t padded = (bytes + 63) / 64 * 64;
    void *block = block_count < sizeof blocks / sizeof *blocks ? aligned_alloc(64, padded) : NULL;
    if (!block) {
        fputs("out of memory\n", stderr);
        exit(1);
    }
    return memset(blocks[block_count++] = block, 0, padded);
}

double *doubles(size_t n)
{
    return allocate(n * sizeof(double));
}

size_t memory_mark(void)
{
    return block_count;
}

void free_to(size_t mark)
{
    while (block_count > mark) {
        free(blocks[--block_count]);
    }
}

void check_below(const char *what, double value, double bound)
{
    const int passed = value >= 0.0 && value < bound;
    checks_passed += passed;
    checks_failed += !passed;
    if (!passed) {
        printf("%s: %g, not below %g\n", what, value, bound);
    }
}

entry *entry_add(const char *task, const char *method, work *run, void *context, double items)
{
    static size_t capacity;
    if (entry_count == capacity) {
        capacity = capacity ? 2 * capacity : 1024;
        entries = realloc(entries, capacity * sizeof *entries);
    }
    entries[entry_count] = (entry) { .task = task, .method = method, .run = run, .context = context, .items = items,
                                     .parameter = -1.0, .error = -1.0, .sample_error = -1.0 };
    return &entries[entry_count++];
}

enum { LOGARITHMS = 1000 };

static double logarithms(void *context)
{
    const double *x = context;
    double sum = 0.0;
    for (int i = 0; i < LOGARITHMS; ++i) {
        sum += log(x[i]);
    }
    return sum;
}

entry *entry_add_logarithm(const char *task)
{
    static double numbers[LOGARITHMS];
    for (int i = 0; i < LOGARITHMS; ++i) {
        numbers[i] = i + 1.0;
    }
    return entry_add(task, "logarithm", logarithms, numbers, LOGARITHMS);
}

static double nanoseconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile_of(const double *sorted, size_t n, double q)
{
    const double position = q * (double)(n - 1);
    const size_t below = (size_t)position;
    const double part = position - (double)below;
    return below + 1 < n ? (1.0 - part) * sorted[below] + part * sorted[below + 1] : sorted[below];
}

double median_of(double *values, size_t n)
{
    qsort(values, n, sizeof *values, ascending);
    return quantile_of(values, n, 0.5);
}

enum { MOST_ROUNDS = 64 };
typedef struct { int repeats, rounds; double times[MOST_ROUNDS]; } series;

/* Time of one run of an entry, repeated. */
static double time_of(const entry *e, int repeats)
{
    const double start = nanoseconds();
    for (int i = 0; i < repeats; ++i) {
        sink = e->run(e->context);
    }
    return (nanoseconds() - start) / repeats;
}

void measure(size_t first, double shape, double amplitude, size_t mark)
{
    /* Long enough for the clock, short enough for many rounds. */
    const double batch = 40e3, slow = 2e6;
    const size_t n = entry_count - first;
    series *all = calloc(n + 1, sizeof *all);
    for (size_t i = 0; i < n && rounds > 0; ++i) {
        sink = entries[first + i].run(entries[first + i].context); /* caches and branch predictors */
        const double once = time_of(&entries[first + i], 1);
        all[i].repeats = once < batch ? (int)(batch / (once + 20.0)) + 1 : 1;
        all[i].rounds = once < slow ? rounds : once < 10.0 * slow ? (rounds + 2) / 3 : 1;
        all[i].times[0] = once;
    }
    for (int round = 0; round < rounds; ++round) {
        for (size_t i = 0; i < n; ++i) {
            if (all[i].rounds > 1 && round < all[i].rounds) {
                all[i].times[round] = time_of(&entries[first + i], all[i].repeats);
            }
        }
    }
    for (size_t i = 0; i < n; ++i) {
        entry *e = &entries[first + i];
        const size_t m = all[i].rounds > 0 ? (size_t)all[i].rounds : 1;
        e->shape = shape;
        e->amplitude = amplitude;
        e->median = median_of(all[i].times, m) / e->items;
        e->low = quantile_of(all[i].times, m, 0.1) / e->items;
        e->high = quantile_of(all[i].times, m, 0.9) / e->items;
    }
    free(all);
    free_to(mark);
}

void entries_write(FILE *file)
{
    fputs("task,shape,amplitude,harmonics,samples,jacobian,method,parameter,error,error_same_samples,median_ns,p10_ns,p90_ns\n",
          file);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        fprintf(file, "%s,%g,%g,%d,%d,%d,%s", e->task, e->shape, e->amplitude, e->harmonics, e->samples, e->jacobian, e->method);
        const double numbers[] = { e->parameter, e->error, e->sample_error, e->median, e->low, e->high };
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k) {
            fprintf(file, numbers[k] >= 0.0 ? ",%.4g" : ",", numbers[k]);
        }
        fputc('\n', file);
    }
}

double first_harmonic_error(const double *force, const double *exact, int components, int coefficients)
{
    double difference = 0.0, size = 0.0;
    for (int k = 0; k < components; ++k) {
        for (int i = k * coefficients + 1; i <= k * coefficients + 2; ++i) {
            difference = hypot(difference, force[i] - exact[i]);
            size = hypot(size, exact[i]);
        }
    }
    return difference / size;
}
