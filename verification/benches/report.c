/* report.c: medians over contacts and amplitudes as tables. */
#include "bench.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 1024 };
typedef struct { double value[MOST]; size_t n; } sample;

static void put(sample *s, double value)
{
    if (s->n < MOST && value >= 0.0) {
        s->value[s->n++] = value;
    }
}

/* The same call, whatever the contact and the amplitude. */
static int same_kind(const entry *a, const entry *b)
{
    return !strcmp(a->task, b->task) && a->harmonics == b->harmonics && a->samples == b->samples;
}

/* Times of one kind of call over shapes and amplitudes, and the largest errors. */
typedef struct { sample own, one; double error, error_of_one; } summary;

static const summary *summary_of(const entry *kind)
{
    static summary s;
    memset(&s, 0, sizeof s);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (same_kind(e, kind) && !strcmp(e->method, "spring-slider")) {
            put(&s.one, e->time);
            s.error_of_one = fmax(s.error_of_one, e->error);
        } else if (same_kind(e, kind) && !strcmp(e->method, "microslip")) {
            put(&s.own, e->time);
            s.error = fmax(s.error, e->error);
        }
    }
    return &s;
}

static const char *cell(const sample *s)
{
    static char text[8][40];
    static int next;
    static const char *const names[] = { "ns", "µs", "ms" };
    char *t = text[next++ % 8];
    sample copy = *s;
    const double time = s->n ? median_of(copy.value, copy.n) : 0.0;
    const int k = time < 999.5 ? 0 : time < 999.5e3 ? 1 : 2;
    snprintf(t, sizeof text[0], s->n ? "%.3g %s" : "–", time / pow(1e3, k), names[k]);
    return t;
}

static void row(FILE *file, const char *title, const char *task)
{
    const summary *s = summary_of(&(entry) { .task = task });
    fprintf(file, "| %s | %s | %s |\n", title, cell(&s->own), cell(&s->one));
}

/* Harmonic force and Jacobian: medians of the times, and the largest errors. */
static void newton_row(FILE *file, const char *contact, const char *task, int harmonics, int samples)
{
    const entry kind = { .task = task, .harmonics = harmonics, .samples = samples };
    summary s = *summary_of(&kind);
    if (s.own.n) {
        fprintf(file, "| %s, H = %d, %d samples | %s | %.0e | %s | %.0e | %.3g |\n", contact, harmonics, samples, cell(&s.own),
                s.error, cell(&s.one), s.error_of_one,
                median_of(s.own.value, s.own.n) / median_of(s.one.value, s.one.n));
    }
}

/* Processor, its caches, and the compiler. */
static const char *machine(void)
{
    static char text[512], model[128] = "unknown processor";
    FILE *info = fopen("/proc/cpuinfo", "r");
    while (info && fgets(text, sizeof text, info) && sscanf(text, "model name : %127[^\n]", model) != 1) {
    }
    if (info) {
        fclose(info);
    }
    int end = snprintf(text, sizeof text, "%s, GCC %s, %s", model, __VERSION__, COMPILER_FLAGS);
#ifdef _SC_LEVEL1_DCACHE_SIZE
    end += snprintf(text + end, sizeof text - (size_t)end, "; caches L1 %ld kB, L2 %ld kB, L3 %ld kB",
                    sysconf(_SC_LEVEL1_DCACHE_SIZE) / 1024, sysconf(_SC_LEVEL2_CACHE_SIZE) / 1024,
                    sysconf(_SC_LEVEL3_CACHE_SIZE) / 1024);
#endif
    snprintf(text + end, sizeof text - (size_t)end, ".\nA contact has %zu bytes, with a state of 8 reversals %zu",
             sizeof(mslip_contact), sizeof(mslip_contact) + mslip_state_length(8) * sizeof(double));
    return text;
}

void write_tables(FILE *file)
{
    fprintf(file, "Measured on: %s.\n\n"
            "What a contact costs in an iteration of Newton's method (harmonic force and Jacobian), and the spring-slider that it "
            "replaces; largest\nerrors of the first harmonic from sampling:\n\n"
            "| contact | microslip | error | one spring-slider | error | ratio of times |\n|---|---:|---:|---:|---:|---:|\n",
            machine());
    static const struct { const char *name, *task; int most; } contacts[] = {
        { "constant load", "harmonic", 9 }, { "varying load", "element", 9 }, { "two directions, varying load", "two directions", 5 },
    };
    for (size_t k = 0; k < sizeof contacts / sizeof *contacts; ++k) {
        for (int h = 1; h <= contacts[k].most; h += 4) {
            newton_row(file, contacts[k].name, contacts[k].task, h, h == 1 || k == 2 ? 64 : h == 5 ? 128 : 256);
        }
    }
    fputs("\n| task | microslip | one spring-slider |\n|---|---:|---:|\n", file);
    row(file, "step of a time integration", "time step");
    row(file, "initialisation of a contact", "initialisation");
    const entry one = { .task = "element", .harmonics = 1, .samples = 64 }, ten = { .task = "face", .harmonics = 1, .samples = 64 };
    sample of_one = summary_of(&one)->own, of_ten = summary_of(&ten)->own;
    fprintf(file, "\nA face of 10 parts with 5 pairs of nodes each takes %.3g times as long as one contact (varying load, H = 1, 64 "
            "samples).\n", median_of(of_ten.value, of_ten.n) / median_of(of_one.value, of_one.n));
}

void write_entries(FILE *file)
{
    fputs("task,shape,amplitude,harmonics,samples,method,error,median_ns\n", file);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        fprintf(file, "%s,%g,%g,%d,%d,%s,%.4g,%.4g\n", e->task, e->shape, e->amplitude, e->harmonics, e->samples, e->method,
                e->error, e->time);
    }
}
