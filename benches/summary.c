/* summary.c: medians over shapes and amplitudes, with the range; costs of equal error. */
#include "summary.h"
#include "measure.h"
#include "tasks.h"

#include <math.h>
#include <string.h>

/* A sample of ratios or times. */
enum { MOST = 1024 };
typedef struct { double value[MOST]; size_t n; int extrapolated; } sample;

static void put(sample *s, double value)
{
    if (s->n < MOST && value >= 0.0) {
        s->value[s->n++] = value;
    }
}

static int is(const entry *e, const char *task, const char *method)
{
    return !strcmp(e->task, task) && !strcmp(e->method, method);
}

static int same_case(const entry *a, const entry *b)
{
    return !strcmp(a->task, b->task) && a->shape == b->shape && a->amplitude == b->amplitude && a->harmonics == b->harmonics
        && a->samples == b->samples && a->jacobian == b->jacobian;
}

/* Time of a method at an error, in the case of an entry: the cheapest that reaches it, or -1. The error of sliders falls as
   sliders^-2, which leads between their numbers, and beyond the last. */
static double cost_at(const entry *at, const char *method, double level, int *extrapolated)
{
    const entry *before = NULL;
    double cheapest = -1.0;
    const int sliders = !strncmp(method, "sliders", 7);
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (!same_case(e, at) || strcmp(e->method, method)) {
            continue;
        }
        const double error = sliders && e->sample_error >= 0.0 ? e->sample_error : e->error;
        if (error > level) {
            before = e;
        } else if (sliders && before) {
            const double error_before = before->sample_error >= 0.0 ? before->sample_error : before->error;
            const double part = log(error_before / level) / log(error_before / fmax(error, 1e-300));
            return before->median * pow(e->median / before->median, part);
        } else if (cheapest < 0.0 || e->median < cheapest) {
            cheapest = e->median;
        }
    }
    if (sliders && cheapest < 0.0 && before) {
        *extrapolated = 1;
        return before->median * sqrt((before->sample_error >= 0.0 ? before->sample_error : before->error) / level);
    }
    return cheapest;
}

static double cheaper(double a, double b)
{
    return a < 0.0 || (b >= 0.0 && b < a) ? b : a;
}

static double quadrature_at(const entry *at, double level)
{
    int ignored = 0;
    return cheaper(cost_at(at, "Eq. 10 by Gauss-Legendre", level, &ignored),
                   cost_at(at, "Eq. 10 by adaptive Gauss-Kronrod", level, &ignored));
}

/* One line of the summary; `at_least` says which side of the target is good. */
static void line(FILE *file, const char *what, const char *target, double limit, int at_least, sample *s, const char *unit,
                 const char *moonshot)
{
    char measured[96] = "-";
    const char *verdict = "";
    if (s->n) {
        const double middle = median_of(s->value, s->n);
        if (s->n == 1) {
            snprintf(measured, sizeof measured, "%.3g%s", middle, unit);
        } else {
            snprintf(measured, sizeof measured, "%.3g%s (%.3g to %.3g)%s", middle, unit, s->value[0], s->value[s->n - 1],
                     s->extrapolated ? " *" : "");
        }
        verdict = (at_least ? middle >= limit : middle <= limit) ? "met" : "missed";
    }
    fprintf(file, "%-62s | %-12s | %-36s | %-8s | %s\n", what, target, measured, moonshot, verdict);
}

void summary_write(FILE *file)
{
    char what[80];
    fprintf(file, "%-62s | %-12s | %-36s | %-8s |\n", "what", "target", "measured: median (range)", "moonshot");

    for (int h = 0; h < ORDERS; ++h) {
        for (int jacobian = 0; jacobian <= 1; ++jacobian) {
            sample s = { .n = 0 };
            for (const entry *e = entries; e < entries + entry_count; ++e) {
                if (is(e, "harmonic", "microslip") && e->harmonics == orders[h] && e->jacobian == jacobian
                    && e->samples >= 64 && e->samples <= 256) {
                    put(&s, e->per_jenkins);
                }
            }
            snprintf(what, sizeof what, "harmonic force / Jenkins AFT, H = %d, N = 64..256%s", orders[h],
                     jacobian ? ", Jacobian" : "");
            line(file, what, "<= 2", 2.0, 0, &s, "", "1");
        }
    }

    sample force = { .n = 0 }, stiffness = { .n = 0 }, march = { .n = 0 }, prepare = { .n = 0 }, quadrature = { .n = 0 };
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (is(e, "force", "microslip") && e->amplitude < 1.0) {
            put(&force, e->per_log);
            const double slow = quadrature_at(e, 1e-8);
            put(&quadrature, slow < 0.0 ? -1.0 : slow / e->median);
        } else if (is(e, "stiffness", "microslip")) {
            put(&stiffness, e->per_log);
        } else if (is(e, "march", "microslip")) {
            put(&march, e->per_jenkins);
        } else if (is(e, "prepare", "microslip")) {
            put(&prepare, 1e-3 * e->median);
        }
    }
    line(file, "force and stiffness at a displacement / logarithm", "<= 4", 4.0, 0, &force, "", "2");
    line(file, "complex stiffness with derivatives / logarithm", "<= 12", 12.0, 0, &stiffness, "", "5");
    line(file, "Masing update / Jenkins step", "<= 5", 5.0, 0, &march, "", "2");
    line(file, "preparation of a contact", "<= 20 us", 20.0, 0, &prepare, " us", "5 us");
    sample bytes = { .value = { sizeof(mslip_contact) }, .n = 1 };
    line(file, "size of a contact", "< 2 kB", 2047.0, 0, &bytes, " B", "");
    line(file, "quadrature of Eq. 10 at 1e-8 / microslip, force", ">= 1000", 1000.0, 1, &quadrature, "", "10000");

    static const struct { double level, target; const char *text, *moonshot; } equal[] = {
        { 1e-4, 3.0, ">= 3", "10" }, { 1e-8, 100.0, ">= 100", "300" },
    };
    static const char *const methods[] = { "sliders evenly spaced", "sliders", "sliders by reversals" };
    for (int k = 0; k < 2; ++k) {
        for (int m = 0; m < 3; ++m) {
            for (int jacobian = 0; jacobian <= 1; ++jacobian) {
                sample s = { .n = 0 };
                for (const entry *e = entries; e < entries + entry_count; ++e) {
                    if (is(e, "harmonic", "microslip") && e->samples == 128 && e->jacobian == jacobian) {
                        const double slow = cost_at(e, methods[m], equal[k].level, &s.extrapolated);
                        put(&s, slow < 0.0 ? -1.0 : slow / e->median);
                    }
                }
                snprintf(what, sizeof what, "%s at %.0e / microslip, N = 128%s", methods[m], equal[k].level,
                         jacobian ? ", Jacobian" : "");
                line(file, what, equal[k].text, equal[k].target, 1, &s, "", equal[k].moonshot);
            }
        }
    }

    static const char *const functions[] = { "batch_complex_stiffness", "batch_masing_update",
                                             "batch_harmonic_force" };
    for (int k = 0; k < 3; ++k) {
        double least = INFINITY, most = 0.0;
        for (const entry *e = entries; e < entries + entry_count; ++e) {
            if (is(e, "many", functions[k])) {
                least = fmin(least, e->median);
                most = fmax(most, e->median);
            }
        }
        sample s = { .n = 0 };
        put(&s, most > 0.0 ? 100.0 * (most / least - 1.0) : -1.0);
        snprintf(what, sizeof what, "%s: spread of the cost of a contact", functions[k]);
        line(file, what, "<= 10 %", 10.0, 0, &s, " %", "");
    }
    fputs("* sliders beyond the largest bank measured: their error falls as sliders^-2, their time grows as sliders.\n", file);
}

static void time_cell(FILE *file, sample *s)
{
    if (!s->n) {
        fputs(" – |", file);
        return;
    }
    const double t = median_of(s->value, s->n);
    if (t < 999.5) {
        fprintf(file, " %.3g ns%s |", t, s->extrapolated ? " *" : "");
    } else if (t < 999.5e3) {
        fprintf(file, " %.3g µs%s |", 1e-3 * t, s->extrapolated ? " *" : "");
    } else {
        fprintf(file, " %.3g ms%s |", 1e-6 * t, s->extrapolated ? " *" : "");
    }
}

/* A row: medians over shapes and amplitudes. */
static void row(FILE *file, const char *title, const char *task, int harmonics, int samples, int jacobian,
                const char *sliders)
{
    sample own = { .n = 0 }, logs = { .n = 0 }, newton = { .n = 0 }, quadrature = { .n = 0 }, coarse = { .n = 0 },
           fine = { .n = 0 }, jenkins = { .n = 0 };
    double error = 0.0;
    for (const entry *e = entries; e < entries + entry_count; ++e) {
        if (strcmp(e->task, task) || e->harmonics != harmonics || e->samples != samples || e->jacobian != jacobian) {
            continue;
        }
        if (!strncmp(e->method, "closed form", 11) && (e->parameter == 0.0 || e->parameter == 32.0)) {
            put(&newton, e->median);
        } else if (e->is_yardstick) {
            put(&jenkins, e->median);
        } else if (!strcmp(e->method, "microslip")) {
            put(&own, e->median);
            put(&logs, e->per_log);
            error = fmax(error, e->sample_error >= 0.0 ? e->sample_error : e->error);
            if (e->amplitude >= 0.0 && e->amplitude < 1.0) {
                put(&quadrature, quadrature_at(e, 1e-8));
            }
            if (sliders) {
                put(&coarse, cost_at(e, sliders, 1e-4, &coarse.extrapolated));
                put(&fine, cost_at(e, sliders, 1e-8, &fine.extrapolated));
            }
        }
    }
    if (!own.n) {
        return;
    }
    fprintf(file, "| %s |", title);
    time_cell(file, &own);
    fprintf(file, " %.2g |", median_of(logs.value, logs.n));
    fprintf(file, " %.0e |", error);
    time_cell(file, &newton);
    time_cell(file, &quadrature);
    time_cell(file, &coarse);
    time_cell(file, &fine);
    time_cell(file, &jenkins);
    fputc('\n', file);
}

void table_write(FILE *file)
{
    fputs("| task | microslip | in logarithms | error | closed form, plain C | Eq. 10 by quadrature, 1e-8 "
          "| parallel sliders, 1e-4 | parallel sliders, 1e-8 | one spring-slider |\n"
          "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n", file);
    row(file, "force and stiffness at a displacement", "force", 0, 0, 0, "sliders");
    row(file, "complex stiffness and derivatives", "stiffness", 0, 0, 0, "sliders");
    for (int h = 0; h < ORDERS; ++h) {
        for (int jacobian = 0; jacobian <= 1; ++jacobian) {
            char title[80];
            snprintf(title, sizeof title, "harmonic force%s, H = %d, 128 samples", jacobian ? " and Jacobian" : "", orders[h]);
            row(file, title, "harmonic", orders[h], 128, jacobian, "sliders");
        }
    }
    row(file, "step of a time march", "march", 0, 0, 0, "sliders");
    row(file, "preparation of a contact", "prepare", 0, 0, 0, NULL);
}
