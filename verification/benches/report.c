/* report.c: errors within their bounds, times at equal error, and medians over contacts and amplitudes as tables. */
#include "bench.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 1024 };
typedef struct { double value[MOST]; size_t n; int extrapolated; } sample;

static void put(sample *s, double value)
{
    if (s->n < MOST && value >= 0.0) {
        s->value[s->n++] = value;
    }
}

static double error_of(const entry *e)
{
    return e->sample_error >= 0.0 ? e->sample_error : e->error;
}

void check_errors(void)
{
    static const struct { const char *task, *method; double parameter, bound; } checks[] = {
        { "force", "sliders", 1024.0, 1e-5 }, { "stiffness", "sliders", 1024.0, 1e-3 }, { "time step", "sliders", 1024.0, 1e-5 },
        { "harmonic", "sliders", 1024.0, 1e-5 }, { "force", "spring-slider", 0.0, 0.1 }, { "time step", "spring-slider", 0.0, 0.1 },
    };
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        char what[128];
        snprintf(what, sizeof what, "%s, %s, a/b = %g, u = %g u_s", e->task, e->method, e->shape, e->amplitude);
        for (size_t k = 0; k < sizeof checks / sizeof *checks; ++k) {
            if (!strcmp(e->task, checks[k].task) && !strcmp(e->method, checks[k].method) && e->parameter == checks[k].parameter) {
                check_below(what, error_of(e), checks[k].bound);
            }
        }
    }
}

/* The same call, whatever the contact and the amplitude. */
static int same_kind(const entry *a, const entry *b)
{
    return !strcmp(a->task, b->task) && a->harmonics == b->harmonics && a->samples == b->samples && a->jacobian == b->jacobian;
}

static int same_call(const entry *a, const entry *b)
{
    return a->shape == b->shape && a->amplitude == b->amplitude && same_kind(a, b);
}

/* Time of a method at an error, or -1. The error of sliders decreases as sliders^-2: times are interpolated between their
   numbers and extrapolated beyond the largest. */
static double time_at(const entry *at, const char *method, double level, int *extrapolated)
{
    const int sliders = !strcmp(method, "sliders");
    const entry *before = NULL;
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (!same_call(e, at) || strcmp(e->method, method)) {
            continue;
        }
        if (error_of(e) <= level) {
            const double ratio = sliders && before ? log(error_of(before) / level) / log(error_of(before) / error_of(e)) : 1.0;
            return before ? before->time * pow(e->time / before->time, ratio) : e->time;
        }
        before = e;
    }
    if (!sliders || !before) {
        return -1.0;
    }
    *extrapolated = 1;
    return before->time * sqrt(error_of(before) / level);
}

/* Times of one kind of call over shapes and amplitudes. */
typedef struct { sample own, coarse, fine, one; double sampling, sampling_of_one; } summary;

static const summary *summary_of(const char *own, const entry *kind)
{
    static summary s;
    memset(&s, 0, sizeof s);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (!same_kind(e, kind)) {
            continue;
        }
        if (!strcmp(e->method, "spring-slider")) {
            put(&s.one, e->time);
            s.sampling_of_one = fmax(s.sampling_of_one, e->error);
        } else if (!strcmp(e->method, own)) {
            put(&s.own, e->time);
            s.sampling = fmax(s.sampling, e->error);
            if (!strcmp(own, "microslip")) {
                put(&s.coarse, time_at(e, "sliders", 1e-4, &s.coarse.extrapolated));
                put(&s.fine, time_at(e, "sliders", 1e-8, &s.fine.extrapolated));
            }
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
    snprintf(t, sizeof text[0], s->n ? "%.3g %s%s" : "–", time / pow(1e3, k), names[k], s->extrapolated ? " *" : "");
    return t;
}

static void row(FILE *file, const char *title, const char *own, const char *task, int harmonics, int samples, int jacobian)
{
    const entry kind = { .task = task, .harmonics = harmonics, .samples = samples, .jacobian = jacobian };
    const summary *s = summary_of(own, &kind);
    if (s->own.n) {
        fprintf(file, "| %s | %s | %s | %s | %s |\n", title, cell(&s->own), cell(&s->coarse), cell(&s->fine), cell(&s->one));
    }
}

/* Harmonic force and Jacobian: medians of the times, and the largest errors. */
static void newton_row(FILE *file, const char *contact, const char *task, int harmonics, int samples)
{
    const entry kind = { .task = task, .harmonics = harmonics, .samples = samples, .jacobian = 1 };
    summary s = *summary_of("microslip", &kind);
    if (s.own.n) {
        fprintf(file, "| %s, H = %d, %d samples | %s | %.0e | %s | %.0e | %.3g |\n", contact, harmonics, samples, cell(&s.own),
                s.sampling, cell(&s.one), s.sampling_of_one,
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
    fputs("\n| task | microslip | parallel sliders, 1e-4 | parallel sliders, 1e-8 | one spring-slider |\n"
          "|---|---:|---:|---:|---:|\n", file);
    row(file, "force and stiffness at a displacement", "microslip", "force", 0, 0, 0);
    row(file, "complex stiffness and derivatives", "microslip", "stiffness", 0, 0, 0);
    for (int h = 1; h <= 9; h += 4) {
        for (int k = 0; k < 4; ++k) {
            const int events = k / 2, jacobian = k % 2;
            char title[96];
            snprintf(title, sizeof title, "harmonic force%s%s, H = %d, 128 %s", jacobian ? " and Jacobian" : "",
                     events ? ", event-driven" : "", h, events ? "nodes" : "samples");
            row(file, title, events ? "microslip event-driven" : "microslip", "harmonic", h, 128, jacobian);
        }
    }
    row(file, "step of a time integration", "microslip", "time step", 0, 0, 0);
    row(file, "initialisation of a contact", "microslip", "initialisation", 0, 0, 0);
}

void write_entries(FILE *file)
{
    fputs("task,shape,amplitude,harmonics,samples,jacobian,method,parameter,error,error_same_samples,median_ns\n", file);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        fprintf(file, "%s,%g,%g,%d,%d,%d,%s", e->task, e->shape, e->amplitude, e->harmonics, e->samples, e->jacobian, e->method);
        const double numbers[] = { e->parameter, e->error, e->sample_error, e->time };
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k) {
            fprintf(file, numbers[k] >= 0.0 ? ",%.4g" : ",", numbers[k]);
        }
        fputc('\n', file);
    }
}
