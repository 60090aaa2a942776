/* measure.c: times of interleaved methods, as medians over rounds. */
#include "bench.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_ENTRIES = 1 << 14, MOST_ROUNDS = 15 };
entry entries[MOST_ENTRIES];
size_t entry_count;
int rounds = 15;

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

entry *entry_add(entry e, const void *context, size_t bytes)
{
    assert(entry_count < MOST_ENTRIES);
    e.error = -1.0;
    e.context = memcpy(allocate(bytes), context, bytes);
    sink = e.run(e.context);
    entries[entry_count] = e;
    return &entries[entry_count++];
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

double median_of(double *values, size_t n)
{
    qsort(values, n, sizeof *values, ascending);
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/* Time of one run of an entry, repeated. */
static double time_of(const entry *e, int repeats)
{
    for (int i = 0; i < repeats / 4; ++i) { /* caches and branch predictors */
        sink = e->run(e->context);
    }
    const double start = nanoseconds();
    for (int i = 0; i < repeats; ++i) {
        sink = e->run(e->context);
    }
    return (nanoseconds() - start) / repeats;
}

typedef struct { int repeats, rounds; double times[MOST_ROUNDS]; } series;

void measure(size_t first)
{
    /* Long enough for the clock, short enough for many rounds. */
    const double batch = 40e3, slow = 2e6;
    const size_t n = entry_count - first;
    series *all = calloc(n, sizeof *all);
    for (size_t i = 0; i < n; ++i) {
        const double once = fmin(time_of(&entries[first + i], 1), time_of(&entries[first + i], 1));
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
        e->time = median_of(all[i].times, (size_t)all[i].rounds) / e->items;
    }
    free(all);
}
