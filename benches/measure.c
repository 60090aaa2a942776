/* measure.c: times of interleaved methods: medians over rounds, with the 10th and 90th percentile. */
#include "measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

entry *entries;
size_t entry_count;
int rounds = 15;
double log_median;
volatile double sink;

static size_t entry_room;
static struct { void *thing; void (*release)(void *); } things[4096];
static size_t thing_count;
static double log_medians[1024];
static size_t log_count;

entry *entry_add(const char *task, const char *method, work *run, void *context, double items)
{
    if (entry_count == entry_room) {
        entry_room = entry_room ? 2 * entry_room : 1024;
        entries = realloc(entries, entry_room * sizeof *entries);
    }
    entries[entry_count] = (entry) { .task = task, .method = method, .shape = -1.0, .amplitude = -1.0, .error = -1.0,
                                     .sample_error = -1.0, .run = run, .context = context, .items = items,
                                     .per_jenkins = -1.0 };
    return &entries[entry_count++];
}

void release_later(void *thing, void (*release)(void *))
{
    if (thing_count == sizeof things / sizeof *things) {
        fputs("too many things in a group\n", stderr);
        exit(1);
    }
    things[thing_count].thing = thing;
    things[thing_count++].release = release;
}

void *context_of(size_t bytes)
{
    void *context = calloc(1, bytes);
    release_later(context, free);
    return context;
}

double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double quantile_of(const double *sorted, size_t n, double q)
{
    const double place = q * (double)(n - 1);
    const size_t below = (size_t)place;
    const double part = place - (double)below;
    return below + 1 < n ? (1.0 - part) * sorted[below] + part * sorted[below + 1] : sorted[below];
}

double median_of(double *values, size_t n)
{
    qsort(values, n, sizeof *values, ascending);
    return quantile_of(values, n, 0.5);
}

enum { LOGS = 1000, MOST_ROUNDS = 64 };

static double logarithms(void *context)
{
    const double *x = context;
    double sum = 0.0;
    for (int i = 0; i < LOGS; ++i) {
        sum += log(x[i]);
    }
    return sum;
}

/* Long enough for the clock, short enough for many rounds. */
static const double batch = 40e-6, slow = 2e-3;

typedef struct { int repeats, rounds; double times[MOST_ROUNDS]; } series;

static void prepare(series *s, work *run, void *context, double items)
{
    sink = run(context); /* caches, tables and branch predictors */
    const double start = seconds();
    sink = run(context);
    const double once = seconds() - start;
    s->repeats = once < batch ? (int)(batch / (once + 2e-8)) + 1 : 1;
    s->times[0] = 1e9 * once / items;
    s->rounds = once < slow ? rounds : once < 10.0 * slow ? (rounds + 2) / 3 : once < 100.0 * slow ? 3 : 1;
}

static void time_once(series *s, work *run, void *context, double items, int round)
{
    /* The one round of what takes longest was in `prepare`. */
    if (s->rounds > 1 && round < s->rounds) {
        const double start = seconds();
        for (int i = 0; i < s->repeats; ++i) {
            sink = run(context);
        }
        s->times[round] = 1e9 * (seconds() - start) / (s->repeats * items);
    }
}

static int same_call(const entry *a, const entry *b)
{
    return !strcmp(a->task, b->task) && a->harmonics == b->harmonics && a->samples == b->samples
        && a->jacobian == b->jacobian && (a->parameter == b->parameter || strcmp(a->task, "many"));
}

void measure(size_t first)
{
    const size_t n = entry_count - first;
    series *all = calloc(n + 1, sizeof *all), *logs = all + n;
    double arguments[LOGS];
    for (int i = 0; i < LOGS; ++i) {
        arguments[i] = 0.5 + 0.0019 * (i * 7919 % LOGS);
    }
    prepare(logs, logarithms, arguments, LOGS);
    for (size_t i = 0; i < n; ++i) {
        prepare(&all[i], entries[first + i].run, entries[first + i].context, entries[first + i].items);
    }
    for (int round = 0; round < rounds; ++round) {
        time_once(logs, logarithms, arguments, LOGS, round);
        for (size_t i = 0; i < n; ++i) {
            const entry *e = &entries[first + i];
            time_once(&all[i], e->run, e->context, e->items, round);
        }
    }
    log_median = median_of(logs->times, (size_t)logs->rounds);
    log_medians[log_count++ % 1024] = log_median;
    for (size_t i = 0; i < n; ++i) {
        entry *e = &entries[first + i];
        const size_t m = (size_t)all[i].rounds;
        e->median = median_of(all[i].times, m);
        e->low = quantile_of(all[i].times, m, 0.1);
        e->high = quantile_of(all[i].times, m, 0.9);
        e->per_log = e->median / log_median;
    }
    for (size_t i = 0; i < n; ++i) {
        entry *e = &entries[first + i];
        for (size_t j = 0; j < n; ++j) {
            const entry *yardstick = &entries[first + j];
            if (yardstick->is_yardstick && same_call(e, yardstick)) {
                e->per_jenkins = e->median / yardstick->median;
            }
        }
    }
    while (thing_count) {
        --thing_count;
        things[thing_count].release(things[thing_count].thing);
    }
    free(all);
}

double log_overall(void)
{
    double copy[1024];
    const size_t n = log_count < 1024 ? log_count : 1024;
    memcpy(copy, log_medians, n * sizeof *copy);
    return n ? median_of(copy, n) : 0.0;
}

/* What is not there stays empty. */
static void number(FILE *file, double value)
{
    if (value >= 0.0) {
        fprintf(file, ",%.4g", value);
    } else {
        fputc(',', file);
    }
}

void entries_write(FILE *file)
{
    fputs("task,shape,amplitude,harmonics,samples,jacobian,method,parameter,error,error_same_samples,"
          "median_ns,p10_ns,p90_ns,per_log,per_jenkins\n", file);
    for (size_t i = 0; i < entry_count; ++i) {
        const entry *e = &entries[i];
        fputs(e->task, file);
        number(file, e->shape);
        number(file, e->amplitude);
        fprintf(file, ",%d,%d,%d,%s", e->harmonics, e->samples, e->jacobian, e->method);
        const double numbers[] = { e->parameter, e->error, e->sample_error, e->median, e->low, e->high, e->per_log,
                                   e->per_jenkins };
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k) {
            number(file, numbers[k]);
        }
        fputc('\n', file);
    }
}
