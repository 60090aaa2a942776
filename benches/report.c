/* report.c: errors within their bounds, times at equal error, and medians over contacts and amplitudes as tables. */
#include "report.h"
#include "cases.h"

#include <math.h>
#include <string.h>

enum { MOST = 4096 };
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
        { "force", "microslip", -1.0, 1e-13 }, { "stiffness", "microslip", -1.0, 1e-12 },
        { "time step", "microslip", -1.0, 1e-13 }, { "initialisation", "microslip", -1.0, 1e-14 },
        { "force", "quadrature", 32.0, 1e-10 }, { "stiffness", "quadrature", 32.0, 1e-6 },
        { "force", "sliders", 1024.0, 1e-5 }, { "stiffness", "sliders", 1024.0, 1e-3 },
        { "time step", "sliders", 1024.0, 1e-5 }, { "harmonic", "sliders", 1024.0, 1e-5 },
        { "force", "spring-slider", -1.0, 0.1 }, { "time step", "spring-slider", -1.0, 0.1 },
    };
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        char what[128];
        snprintf(what, sizeof what, "%s, %s, a/b = %g, u = %g u_s", e->task, e->method, e->shape, e->amplitude);
        for (size_t k = 0; k < sizeof checks / sizeof *checks; ++k) {
            if (!strcmp(e->task, checks[k].task) && !strcmp(e->method, checks[k].method)
                && fabs(e->parameter - checks[k].parameter) < 1e-15) {
                check_below(what, error_of(e), checks[k].bound);
            }
        }
        if (!strcmp(e->task, "harmonic") && !strcmp(e->method, "microslip") && e->sample_error >= 0.0) {
            check_below(what, e->sample_error, 1e-13);
        }
    }
}

static int same_call(const entry *a, const entry *b)
{
    return !strcmp(a->task, b->task) && a->shape == b->shape && a->amplitude == b->amplitude && a->harmonics == b->harmonics
        && a->samples == b->samples && a->jacobian == b->jacobian;
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
            return before ? before->median * pow(e->median / before->median, ratio) : e->median;
        }
        before = e;
    }
    if (!sliders || !before) {
        return -1.0;
    }
    *extrapolated = 1;
    return before->median * sqrt(error_of(before) / level);
}

/* Medians over shapes and amplitudes of one call, for the method whose cost is in the second column. */
typedef struct { sample own, quadrature, coarse, fine, one; double error; } summary;

static const summary *summary_of(const char *own, const char *task, int harmonics, int samples, int jacobian)
{
    static summary s;
    memset(&s, 0, sizeof s);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (strcmp(e->task, task) || e->harmonics != harmonics || e->samples != samples || e->jacobian != jacobian) {
            continue;
        }
        if (!strcmp(e->method, "spring-slider")) {
            const double other = time_at(e, "spring-slider by reversals", INFINITY, &s.one.extrapolated);
            put(&s.one, other >= 0.0 ? fmin(e->median, other) : e->median);
        } else if (!strcmp(e->method, own)) {
            put(&s.own, e->median);
            if (strcmp(own, "microslip")) { /* event-driven: against exact integrals, not at equal samples */
                s.error = fmax(s.error, e->error);
                continue;
            }
            s.error = fmax(s.error, error_of(e));
            if (e->amplitude < 1.0) { /* gross slip needs no quadrature */
                put(&s.quadrature, time_at(e, "quadrature", 1e-8, &s.quadrature.extrapolated));
            }
            put(&s.coarse, time_at(e, "sliders", 1e-4, &s.coarse.extrapolated));
            put(&s.fine, time_at(e, "sliders", 1e-8, &s.fine.extrapolated));
        }
    }
    return &s;
}

static const char *text_of(double nanoseconds)
{
    static char text[8][32];
    static int next;
    char *t = text[next++ % 8];
    const double units[] = { 1.0, 1e3, 1e6 };
    const int k = nanoseconds < 999.5 ? 0 : nanoseconds < 999.5e3 ? 1 : 2;
    static const char *const names[] = { "ns", "µs", "ms" };
    snprintf(t, sizeof text[0], "%.3g %s", nanoseconds / units[k], names[k]);
    return t;
}

static const char *cell(const sample *s)
{
    static char text[8][40];
    static int next;
    char *t = text[next++ % 8];
    sample copy = *s;
    snprintf(t, sizeof text[0], "%s%s", s->n ? text_of(median_of(copy.value, copy.n)) : "–", s->extrapolated ? " *" : "");
    return t;
}

static void row(FILE *file, const char *title, const char *own, const char *task, int harmonics, int samples, int jacobian)
{
    const summary *s = summary_of(own, task, harmonics, samples, jacobian);
    if (s->own.n) {
        fprintf(file, "| %s | %s | %.0e | %s | %s | %s | %s |\n", title, cell(&s->own), s->error, cell(&s->quadrature),
                cell(&s->coarse), cell(&s->fine), cell(&s->one));
    }
}

/* Times of complex stiffness over a range of amplitudes, sorted, for one or all (negative) shapes. */
static double stiffness_range(const char *task, const char *method, double shape, sample *s)
{
    double sum = 0.0;
    s->n = 0;
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (!strcmp(e->task, task) && !strcmp(e->method, method) && (shape < 0.0 || e->shape == shape)) {
            put(s, e->median);
            sum += e->median;
        }
    }
    median_of(s->value, s->n); /* sorts */
    return s->n ? sum / (double)s->n : 0.0;
}

/* Median of the times of microslip over those of the fastest of some methods, and the largest; all that match a call. */
static const char *ratios(const char *task, const char *const *methods, double parameter, int harmonics, int samples, int jacobian)
{
    static char text[8][48];
    static int next;
    char *t = text[next++ % 8];
    sample s = { .n = 0 };
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (strcmp(e->task, task) || strcmp(e->method, "microslip") || e->harmonics != harmonics || e->jacobian != jacobian
            || e->parameter != parameter || (samples && e->samples != samples)) {
            continue;
        }
        double fastest = INFINITY;
        for (const entry *o = entries; o < entries + entry_count; ++o) {
            for (const char *const *method = methods; *method; ++method) {
                if (!strcmp(o->method, *method) && same_call(e, o) && o->parameter == parameter) {
                    fastest = fmin(fastest, o->median);
                }
            }
        }
        put(&s, fastest < INFINITY ? e->median / fastest : -1.0);
    }
    if (!s.n) {
        return "–";
    }
    const double median = median_of(s.value, s.n);
    snprintf(t, sizeof text[0], "%.2f (%.2f)", median, s.value[s.n - 1]);
    return t;
}

static void write_element_table(FILE *file)
{
    fputs("\nTime of an element under a varying normal force over that of one spring-slider with a varying limit: median over the "
          "shapes,\nin brackets the largest. H = 1, 5, 9 with 64, 128, 256 samples.\n\n"
          "| motion | force, H = 1 | H = 5 | H = 9 | with Jacobian, H = 1 | H = 5 | H = 9 | step |\n"
          "|---|---:|---:|---:|---:|---:|---:|---:|\n", file);
    static const char *const methods[] = { "spring-slider", NULL };
    for (int motion = 0; element_motion(motion); ++motion) {
        fprintf(file, "| %s", element_motion(motion));
        for (int jacobian = 0; jacobian <= 1; ++jacobian) {
            for (int h = 1; h <= 9; h += 4) {
                fprintf(file, " | %s", ratios("element", methods, motion, h, 0, jacobian));
            }
        }
        fprintf(file, " | %s |\n", ratios("element step", methods, motion, 0, 0, 0));
    }
    static const char *const logarithm[] = { "logarithm", NULL };
    const summary *s = summary_of("microslip", "element initialisation", 0, 0, 0);
    fprintf(file, "\nInitialisation of an element: %s, %.1f kB. Normal force and stiffness over one logarithm: %s.\n",
            cell(&s->own), sizeof(mslip_element) / 1e3, ratios("normal force", logarithm, 0, 0, 0, 0));
}

/* Median of a method of batches of that size, or a negative number. */
static double time_of_batch(const char *method, double n)
{
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (!strcmp(e->task, "batch") && !strcmp(e->method, method) && e->parameter == n) {
            return e->median;
        }
    }
    return -1.0;
}

static void write_step_tables(FILE *file)
{
    static const char *const steps[][2] = { { "microslip", "in place" }, { "microslip, new state", "to a new state" } };
    fputs("\nA step of a time integration over one logarithm, median over shapes and amplitudes", file);
    for (int k = 0; k < 2; ++k) {
        sample s = { .n = 0 };
        for (const entry *e = entries; e < entries + entry_count; ++e) {
            for (const entry *o = entries; o < entries + entry_count; ++o) {
                if (!strcmp(e->task, "time step") && !strcmp(e->method, steps[k][0]) && !strcmp(o->method, "logarithm")
                    && same_call(e, o)) {
                    put(&s, e->median / o->median);
                }
            }
        }
        if (s.n) {
            fprintf(file, "%s %s: %.2f", k ? ";" : ",", steps[k][1], median_of(s.value, s.n));
        }
    }
    fputs(".\n", file);

    static const char *const methods[] = { "mslip_batch_complex_stiffness", "mslip_batch_harmonic_force",
        "mslip_batch_masing_update", "logarithm", "mslip_batch_element_update", "spring-slider, one step" };
    enum { CONTACT_STEP = 2, LOGARITHM, ELEMENT_STEP, METHODS = 6 };
    double least[METHODS] = { 0.0 }, largest[METHODS] = { 0.0 };
    fputs("\nOne item of a batch, a/b = 0.3, at 0.7 of gross slip: contacts of 64 different loads, and elements of one kind "
          "(harmonic\nforce and Jacobian of one harmonic with 64 samples; a step of 16 in a period, with its stiffness):\n\n"
          "| items | complex stiffness | harmonic force | step | step over one logarithm | step of an element | step of one "
          "spring-slider |\n|---:|---:|---:|---:|---:|---:|---:|\n", file);
    for (double n = 100.0; n <= 1e6; n *= 10.0) {
        double t[METHODS];
        for (int k = 0; k < METHODS; ++k) {
            t[k] = time_of_batch(methods[k], n);
        }
        for (int k = 0; k < METHODS; ++k) {
            const double logarithms = t[k] / t[LOGARITHM];
            least[k] = n == 100.0 ? logarithms : t[k] >= 0.0 ? fmin(least[k], logarithms) : least[k];
            largest[k] = t[k] >= 0.0 ? fmax(largest[k], logarithms) : largest[k];
        }
        if (t[0] >= 0.0) {
            fprintf(file, "| %.0f | %s | %s | %s | %.2f | %s | %s |\n", n, text_of(t[0]), text_of(t[1]), text_of(t[CONTACT_STEP]),
                    t[CONTACT_STEP] / t[LOGARITHM], t[ELEMENT_STEP] < 0.0 ? "–" : text_of(t[ELEMENT_STEP]),
                    text_of(t[METHODS - 1]));
        }
    }
    fprintf(file, "\nLargest over least time of a step over these sizes: contacts %.2f, elements %.2f.\n",
            largest[CONTACT_STEP] / least[CONTACT_STEP], largest[ELEMENT_STEP] / least[ELEMENT_STEP]);
}

static void write_stiffness_table(FILE *file)
{
    fputs("\nComplex stiffness with derivatives, over one logarithm: mean and worst of 200 amplitudes spaced uniformly up to twice "
          "the\ndisplacement of gross slip, and worst of 30 that approach it from both sides. The table of a shape is made once.\n\n"
          "| a/b | single calls | worst | near gross slip | tabulated | worst | near gross slip | table |\n"
          "|---:|---:|---:|---:|---:|---:|---:|---:|\n", file);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (strcmp(e->task, "stiffness table") || strcmp(e->method, "logarithm")) {
            continue;
        }
        sample single, tabulated, single_near, tabulated_near, table;
        const double mean = stiffness_range("stiffness over amplitude", "microslip", e->shape, &single);
        const double mean_tabulated = stiffness_range("stiffness over amplitude", "tabulated", e->shape, &tabulated);
        stiffness_range("stiffness near gross slip", "microslip", e->shape, &single_near);
        stiffness_range("stiffness near gross slip", "tabulated", e->shape, &tabulated_near);
        const double t = stiffness_range("stiffness table", "microslip", e->shape, &table), unit = 1.0 / e->median;
        fprintf(file, "| %g | %.0f | %.0f | %.0f | %.2f | %.2f | %.2f | %s |\n", e->shape, mean * unit,
                single.value[single.n - 1] * unit, single_near.value[single_near.n - 1] * unit, mean_tabulated * unit,
                tabulated.value[tabulated.n - 1] * unit, tabulated_near.value[tabulated_near.n - 1] * unit, text_of(t));
    }
    fprintf(file, "\nA table has %.1f kB.\n", 8e-3 * (double)mslip_stiffness_table_length());
}

static void write_two_directions_tables(FILE *file)
{
    fputs("\nA step of an element with two tangential directions, a/b = 0.3, of 64 in a period: mean over the second period, and the "
          "slowest\nstep. Amplitudes over the slip displacement of the mean load.\n\n"
          "| motion | amplitude | force | slowest | with tangent | slowest |\n|---|---:|---:|---:|---:|---:|\n", file);
    for (int motion = 0; two_directions_motion(motion); ++motion) {
        double amplitude = -1.0, mean[2] = { -1.0, -1.0 }, slowest[2] = { -1.0, -1.0 };
        for (const entry *e = entries; e < entries + entry_count; ++e) {
            if (!strcmp(e->task, "two directions step") && e->parameter == motion) {
                double *to = (strcmp(e->method, "microslip") ? slowest : mean) + e->jacobian;
                *to = fmax(*to, e->median);
                amplitude = e->amplitude;
            }
        }
        if (amplitude >= 0.0) {
            fprintf(file, "| %s | %g | %s | %s | %s | %s |\n", two_directions_motion(motion), amplitude, text_of(mean[0]),
                    text_of(slowest[0]), text_of(mean[1]), text_of(slowest[1]));
        }
    }
    fputs("\nHarmonic force and Jacobian of two tangential directions on the circle with varying load, 64 samples, and ratios to\n"
          "spring-sliders in the plane:\n\n"
          "| H | microslip | one spring-slider | 64 spring-sliders | over one | over 64 |\n|---:|---:|---:|---:|---:|---:|\n", file);
    for (int h = 1; h <= 5; h += 4) {
        double t[3] = { -1.0, -1.0, -1.0 };
        for (const entry *e = entries; e < entries + entry_count; ++e) {
            if (!strcmp(e->task, "two directions harmonic") && e->harmonics == h) {
                t[!strcmp(e->method, "microslip") ? 0 : !strcmp(e->method, "spring-slider") ? 1 : 2] = e->median;
            }
        }
        if (t[0] >= 0.0) {
            fprintf(file, "| %d | %s | %s | %s | %.2f | %.2f |\n", h, text_of(t[0]), text_of(t[1]), text_of(t[2]), t[0] / t[1],
                    t[0] / t[2]);
        }
    }
}

/* Harmonic force and Jacobian: medians of the times, and the largest errors. */
static void newton_row(FILE *file, const char *contact, const char *task, double parameter, int harmonics, int samples)
{
    sample own = { .n = 0 }, one = { .n = 0 };
    double error = 0.0, error_of_one = 0.0;
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (strcmp(e->task, task) || e->parameter != parameter || e->harmonics != harmonics || e->samples != samples
            || !e->jacobian) {
            continue;
        }
        if (!strcmp(e->method, "microslip")) {
            put(&own, e->median);
            error = fmax(error, e->error);
        } else if (!strcmp(e->method, "spring-slider")) {
            const double other = time_at(e, "spring-slider by reversals", INFINITY, &one.extrapolated);
            put(&one, other >= 0.0 ? fmin(e->median, other) : e->median);
            error_of_one = fmax(error_of_one, e->error);
        }
    }
    if (own.n) {
        const double ratio = median_of(own.value, own.n) / median_of(one.value, one.n);
        fprintf(file, "| %s, H = %d, %d samples | %s | %.0e | %s | %.0e | %.2g |\n", contact, harmonics, samples, cell(&own), error,
                cell(&one), error_of_one, ratio);
    }
}

static void write_newton_table(FILE *file)
{
    fputs("What a contact costs in an iteration of Newton's method (harmonic force and Jacobian), and the spring-slider that it "
          "replaces; largest\nerrors of the first harmonic from sampling:\n\n"
          "| contact | microslip | error | one spring-slider | error | ratio of times |\n|---|---:|---:|---:|---:|---:|\n", file);
    static const struct { const char *name, *task; double parameter; int most; } contacts[] = {
        { "constant load", "harmonic", -1.0, 9 }, { "varying load", "element", 0.0, 9 },
        { "two directions, varying load", "two directions harmonic", 5.0, 5 },
    };
    for (size_t k = 0; k < sizeof contacts / sizeof *contacts; ++k) {
        for (int h = 1; h <= contacts[k].most; h += 4) {
            const int samples = h == 1 || k == 2 ? 64 : h == 5 ? 128 : 256;
            newton_row(file, contacts[k].name, contacts[k].task, contacts[k].parameter, h, samples);
        }
    }
    fputs("\n", file);
}

void write_tables(FILE *file, const char *machine)
{
    char title[96];
    fprintf(file, "Measured on: %s.\n\n", machine);
    write_newton_table(file);
    fputs("| task | microslip | error | Eq. 10 by quadrature, 1e-8 | parallel sliders, 1e-4 | parallel sliders, 1e-8 "
          "| one spring-slider |\n|---|---:|---:|---:|---:|---:|---:|\n", file);
    row(file, "force and stiffness at a displacement", "microslip", "force", 0, 0, 0);
    row(file, "complex stiffness and derivatives", "microslip", "stiffness", 0, 0, 0);
    for (int h = 1; h <= 9; h += 4) {
        for (int events = 0; events <= 1; ++events) {
            for (int jacobian = 0; jacobian <= 1; ++jacobian) {
                snprintf(title, sizeof title, "harmonic force%s%s, H = %d, 128 %s", jacobian ? " and Jacobian" : "",
                         events ? ", event-driven" : "", h, events ? "nodes" : "samples");
                row(file, title, events ? "microslip event-driven" : "microslip", "harmonic", h, 128, jacobian);
            }
        }
    }
    row(file, "step of a time integration", "microslip", "time step", 0, 0, 0);
    row(file, "initialisation of a contact", "microslip", "initialisation", 0, 0, 0);
}

void write_details(FILE *file)
{
    write_stiffness_table(file);
    write_step_tables(file);
    write_element_table(file);
    write_two_directions_tables(file);
}
