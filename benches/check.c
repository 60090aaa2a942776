/* check.c: is the benchmark itself right? The truth against the tables of golden/, errors that fall as they should, and ways
   to the same number that agree. */
#include "check_benchmark.h"
#include "../c_tests/check.h"
#include "measure.h"
#include "tasks.h"

#include <stdlib.h>

enum { COLUMNS = 24, CONTACTS = 64 };

static mslip_parameters contact[CONTACTS];
static reference *truth[CONTACTS];

/* Calls `row` with the numbers of every `stride`-th row of a table. */
static int table(const char *directory, const char *name, int stride, void (*row)(const double *))
{
    char path[512], text[1024];
    int rows = 0;
    snprintf(path, sizeof path, "%s/%s.csv", directory, name);
    FILE *file = fopen(path, "r");
    if (!CHECK(file != NULL)) {
        return 0;
    }
    for (int number = -1; fgets(text, sizeof text, file); ++number) {
        double values[COLUMNS];
        int n = 0;
        for (char *p = text; number >= 0 && number % stride == 0 && n < COLUMNS; ++p) {
            values[n++] = strtod(p, &p);
            if (*p != ',') {
                break;
            }
        }
        if (n) {
            row(values);
            ++rows;
        }
    }
    fclose(file);
    return CHECK(rows > 0);
}

static void contact_row(const double *v)
{
    const int i = (int)v[0];
    mslip_parameters *p = &contact[i];
    mslip_parameters_default(p);
    p->flat_half_width = v[1];
    p->edge_radius = v[2];
    p->length = v[3];
    p->normal_force = v[4];
    p->friction_coefficient = v[5];
    for (int k = 0; k < 2; ++k) {
        p->material[k].young_modulus = v[6 + 2 * k];
        p->material[k].poisson_ratio = v[7 + 2 * k];
    }
    truth[i] = reference_of(p);
    CHECK_RELATIVE(reference_slip_displacement(truth[i]), v[13], 1e-15);
}

static void monotonic_row(const double *v)
{
    const reference *r = truth[(int)v[0]];
    CHECK_RELATIVE(reference_displacement(r, v[1]), v[3], 1e-15);
}

static void inverse_row(const double *v)
{
    double force, stiffness;
    reference_curve(truth[(int)v[0]], v[1], &force, &stiffness);
    CHECK_RELATIVE(force, v[2], 1e-15);
}

static void stiffness_row(const double *v)
{
    double got[4];
    reference_stiffness(truth[(int)v[0]], v[1], got);
    CHECK_RELATIVE(got[0], v[2], 1e-14);
    CHECK_NEAR(got[1], v[3], 1e-14 * v[2]);
    for (int k = 2; k < 4; ++k) {
        if (!isnan(v[2 + k])) {
            CHECK_NEAR(got[k], v[2 + k], 1e-12 * v[2] / v[1]);
        }
    }
}

static void harmonic_row(const double *v)
{
    enum { H = 3, N = 2 * H + 1 };
    double got[N];
    reference_samples(truth[(int)v[1]], H, (int)v[2], v + 3, got);
    for (int k = 0; k < N; ++k) {
        CHECK_NEAR(got[k], v[3 + N + k], 1e-14 * fabs(v[3 + N + 1]));
    }
}

static void against_golden(const char *golden)
{
    table(golden, "contacts", 1, contact_row);
    table(golden, "monotonic", 7, monotonic_row);
    table(golden, "monotonic_inverse", 3, inverse_row);
    table(golden, "complex_stiffness", 19, stiffness_row);
    table(golden, "harmonic_force", 3, harmonic_row);
    for (int i = 0; i < CONTACTS; ++i) {
        free(truth[i]);
    }
}

/* Force and Jacobian of sliders by all ways, and the Jacobian as a difference. */
static void sliders_agree(const subject *s, double size, int harmonics)
{
    enum { SAMPLES = 48, MOST = 11 };
    const int n = 2 * harmonics + 1;
    double c[MOST], f[2][MOST], j[2][MOST * MOST], high[MOST], low[MOST];
    sliders one = jenkins_of(s, 0.5 * s->contact.slip_displacement);
    const sliders *bank = bank_of(s, 16);
    aft *a = aft_of(harmonics, SAMPLES, bank->n);
    motion_of(harmonics, size * s->contact.slip_displacement, c);
    for (int which = 0; which < 2; ++which) {
        const sliders *of = which ? bank : &one;
        if (which) {
            sliders_stepped(a, of, c, f[0], j[0]);
        } else {
            jenkins_stepped(a, of, c, f[0], j[0]);
        }
        sliders_by_reversals(a, of, c, f[1], j[1]);
        for (int i = 0; i < n; ++i) {
            CHECK_NEAR(f[0][i], f[1][i], 1e-13 * s->contact.slip_force);
        }
        for (int i = 0; i < n * n; ++i) {
            CHECK_NEAR(j[0][i], j[1][i], 1e-12 * s->contact.initial_stiffness);
        }
        for (int k = 0; k < n; ++k) {
            const double kept = c[k], step = 1e-7 * s->contact.slip_displacement;
            c[k] = kept + step;
            sliders_by_reversals(a, of, c, high, NULL);
            c[k] = kept - step;
            sliders_by_reversals(a, of, c, low, NULL);
            c[k] = kept;
            for (int i = 0; i < n; ++i) {
                CHECK_NEAR((high[i] - low[i]) / (2.0 * step), j[0][i + n * k], 1e-6 * s->contact.initial_stiffness);
            }
        }
    }
    aft_free(a);
    sliders_free(&one);
}

/* From the first to the last of a method in each case the error falls by a power of the parameter, or to rounding. */
static void falls(const char *task, const char *method, double power, double rounding)
{
    int series = 0;
    for (size_t i = 0; i < entry_count; ++i) {
        const entry *first = &entries[i], *last = first;
        if (strcmp(first->task, task) || strcmp(first->method, method)) {
            continue;
        }
        while (i + 1 < entry_count && entries[i + 1].shape == first->shape && entries[i + 1].amplitude == first->amplitude
               && !strcmp(entries[i + 1].task, task)) {
            const entry *next = &entries[++i];
            if (!strcmp(next->method, method) && next->jacobian == first->jacobian && next->samples == first->samples) {
                last = next;
            }
        }
        const double error = first->sample_error >= 0.0 ? first->sample_error : first->error;
        const double end = last->sample_error >= 0.0 ? last->sample_error : last->error;
        const double wanted = error * pow(last->parameter / first->parameter, -power);
        if (!CHECK(last > first && (end <= fmax(wanted, rounding)))) {
            printf("    %s, %s, a/b = %g: from %g at %g to %g at %g\n", task, method, first->shape, error, first->parameter,
                   end, last->parameter);
        }
        ++series;
    }
    CHECK(series > 0);
}

/* The largest error of a method. */
static void below(const char *task, const char *method, double limit)
{
    double worst = -1.0;
    for (size_t i = 0; i < entry_count; ++i) {
        const entry *e = &entries[i];
        if (!strcmp(e->task, task) && !strcmp(e->method, method)) {
            worst = fmax(worst, e->sample_error >= 0.0 ? e->sample_error : e->error);
        }
    }
    if (!CHECK(worst >= 0.0 && worst < limit)) {
        printf("    %s, %s: %g\n", task, method, worst);
    }
}

/* Sampling errors fall as samples^-2, give or take how the samples miss the turning points. */
static void samples_fall(const char *method)
{
    for (size_t i = 0; i < entry_count; ++i) {
        const entry *few = &entries[i];
        for (size_t k = i; k < entry_count; ++k) {
            const entry *many = &entries[k];
            if (!strcmp(few->task, "harmonic") && !strcmp(few->method, method) && !strcmp(many->task, "harmonic")
                && !strcmp(many->method, method) && many->samples == 8 * few->samples && many->harmonics == few->harmonics
                && many->jacobian == few->jacobian && many->shape == few->shape && many->amplitude == few->amplitude) {
                if (!CHECK(many->error < fmax(few->error / 4.0, 1e-12))) {
                    printf("    H = %d, a/b = %g: %g, %g\n", few->harmonics, few->shape, few->error, many->error);
                }
            }
        }
    }
}

int check_benchmark(const char *golden)
{
    static const double shape[] = { 0.0, 0.9 }, amplitude[] = { 0.5 };
    static const int order[] = { 1, 5 };
    const extent tiny = { .name = "check", .shapes = 2, .amplitudes = 1, .orders = 2, .shape = shape, .amplitude = amplitude,
                          .order = order, .least_samples = 16, .most_samples = 128, .most_sliders = 256, .most_nodes = 64,
                          .most_contacts = 10 };
    against_golden(golden);
    rounds = 1;
    for (int i = 0; i < tiny.shapes; ++i) {
        subject s = subject_of(tiny.shape[i], tiny.most_sliders);
        task_force(&s, &tiny);
        task_stiffness(&s, &tiny);
        for (int h = 0; h < tiny.orders; ++h) {
            task_harmonic(&s, &tiny, tiny.order[h]);
            sliders_agree(&s, 0.8, tiny.order[h]);
            sliders_agree(&s, 3.0, tiny.order[h]);
        }
        task_march(&s, &tiny);
        task_prepare(&s);
        task_many(&s, &tiny);
        subject_free(&s);
    }
    below("force", "microslip", 1e-13);
    below("stiffness", "microslip", 1e-12);
    below("harmonic", "microslip", 1e-13);
    below("march", "microslip", 1e-13);
    below("prepare", "microslip", 1e-14);
    below("force", "closed form by Newton", 1e-11);
    below("force", "Jenkins", 0.5);
    below("stiffness", "Jenkins", 0.5);
    falls("force", "Eq. 10 by Gauss-Legendre", 1.0, 0.0);
    falls("force", "Eq. 10 by adaptive Gauss-Kronrod", -0.8, 1e-10);
    falls("force", "sliders", 1.5, 0.0);
    falls("stiffness", "closed form by Gauss-Legendre", 4.0, 1e-8);
    falls("stiffness", "Eq. 10 by Gauss-Legendre", 0.5, 0.0);
    falls("stiffness", "Eq. 10 by adaptive Gauss-Kronrod", -0.8, 1e-9);
    falls("stiffness", "sliders", 0.5, 0.0); /* their derivatives jump */
    falls("harmonic", "sliders", 1.5, 0.0);
    falls("harmonic", "sliders by reversals", 1.5, 0.0);
    falls("march", "sliders", 1.5, 0.0);
    below("harmonic", "closed form by Newton", 1e-10);
    below("march", "closed form by Newton", 1e-10);
    samples_fall("microslip");
    samples_fall("microslip event-driven");
    return check_report();
}
