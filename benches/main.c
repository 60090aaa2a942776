/* main.c: run time against error of microslip and of what one would use instead.
 *
 *   bench [--quick] DIRECTORY    measures, and writes bench.csv, summary.txt and table.md there
 *   bench --check GOLDEN         tests the benchmark itself against the reference tables */
#include "check_benchmark.h"
#include "measure.h"
#include "summary.h"
#include "tasks.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double few_shapes[] = { 0.0, 0.9 }, few_amplitudes[] = { 0.95 };

static const extent full = { .name = "full", .shapes = SHAPES, .amplitudes = AMPLITUDES, .orders = ORDERS, .shape = shapes,
    .amplitude = amplitudes, .order = orders, .least_samples = 16, .most_samples = 1024, .most_sliders = 4096,
    .most_nodes = 1024, .most_contacts = 100000 };

static const extent quick = { .name = "quick", .shapes = 2, .amplitudes = 1, .orders = ORDERS, .shape = few_shapes,
    .amplitude = few_amplitudes, .order = orders, .least_samples = 64, .most_samples = 128, .most_sliders = 1024,
    .most_nodes = 128, .most_contacts = 10000 };

static const char *const left_out =
    "Left out: quadrature of Eq. 10 inside the harmonic force and the time march (each sample would cost what a force costs);\n"
    "  the Jacobian of the closed form by Newton (it would need what the library has);\n"
    "  an interpolated table of the curve (the same law once more, with tables to be kept for every contact);\n"
    "  sliders beyond the largest bank; three-dimensional contact codes (minutes where these take microseconds);\n"
    "  the error against equal samples beyond 128 samples (quadruple precision would take longer than all the rest).\n";

static FILE *open_file(const char *directory, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

/* What the machine is: the times are its own. */
static void machine_write(FILE *file)
{
    char text[256], model[128] = "unknown processor";
    FILE *info = fopen("/proc/cpuinfo", "r");
    while (info && fgets(text, sizeof text, info)) {
        const char *colon = strchr(text, ':');
        if (!strncmp(text, "model name", 10) && colon) {
            snprintf(model, sizeof model, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
            break;
        }
    }
    if (info) {
        fclose(info);
    }
    fprintf(file, "%s, GCC %s, %s; one logarithm of the C library takes %.3g ns", model, __VERSION__, COMPILER_FLAGS,
            log_overall());
}

static void caches_write(FILE *file)
{
    fputs("Caches: ", file);
#ifdef _SC_LEVEL1_DCACHE_SIZE
    fprintf(file, "L1 %ld kB, L2 %ld kB, L3 %ld kB", sysconf(_SC_LEVEL1_DCACHE_SIZE) / 1024,
            sysconf(_SC_LEVEL2_CACHE_SIZE) / 1024, sysconf(_SC_LEVEL3_CACHE_SIZE) / 1024);
#else
    fputs("sizes unknown", file);
#endif
    fprintf(file, "; a contact has %zu B, with a state of 8 reversals %zu B: what an interface reads no longer fits where\n"
            "  contacts times bytes exceed these.\n", sizeof(mslip_contact),
            sizeof(mslip_contact) + mslip_state_length(8) * sizeof(double));
}

static void run(const extent *x)
{
    const double start = seconds();
    for (int i = 0; i < x->shapes; ++i) {
        subject s = subject_of(x->shape[i], x->most_sliders);
        fprintf(stderr, "a/b = %-5g  force", s.shape);
        task_force(&s, x);
        fputs(", complex stiffness", stderr);
        task_stiffness(&s, x);
        for (int h = 0; h < x->orders; ++h) {
            fprintf(stderr, ", %s%d", h ? "" : "harmonics ", x->order[h]);
            task_harmonic(&s, x, x->order[h]);
        }
        fputs(", time march", stderr);
        task_march(&s, x);
        fputs(", preparation", stderr);
        task_prepare(&s);
        if (i == 1) {
            fprintf(stderr, ", %zu contacts", x->most_contacts);
            task_many(&s, x);
        }
        fprintf(stderr, " (%.0f s)\n", seconds() - start);
        subject_free(&s);
    }
}

int main(int argc, char **argv)
{
    const int is_quick = argc == 3 && !strcmp(argv[1], "--quick");
    if (argc == 3 && !strcmp(argv[1], "--check")) {
        return check_benchmark(argv[2]);
    }
    if (argc != 2 && !is_quick) {
        fprintf(stderr, "usage: %s [--quick] DIRECTORY\n       %s --check GOLDEN\n", argv[0], argv[0]);
        return 2;
    }
    const char *directory = argv[argc - 1];
    rounds = is_quick ? 7 : 15;
    run(is_quick ? &quick : &full);

    FILE *csv = open_file(directory, "bench.csv"), *summary = open_file(directory, "summary.txt"),
         *table = open_file(directory, "table.md");
    entries_write(csv);
    table_write(table);
    fputs("\nMedians over contacts from the cylinder to a/b = 0.999 and over amplitudes from 0.01 to 3 times the "
          "displacement of gross slip; quadrature without gross slip. Errors are relative to quadruple precision, those of the harmonic force at equal "
          "samples; times marked * are beyond the largest bank of sliders, which step every sample. Left out: quadrature inside "
          "the harmonic force and the time march (a sample would cost what a force costs), the closed form's Jacobian (it would "
          "need what the library has), interpolated tables of the curve (the same law again, with tables to be kept for every "
          "contact), three-dimensional contact codes (minutes where these take microseconds). ", table);
    machine_write(table);
    fputs(".\n", table);
    FILE *const outputs[] = { stdout, summary };
    for (int i = 0; i < 2; ++i) {
        machine_write(outputs[i]);
        fputs(".\n\n", outputs[i]);
        summary_write(outputs[i]);
        caches_write(outputs[i]);
        fputs(left_out, outputs[i]);
    }
    fclose(csv);
    fclose(summary);
    fclose(table);
    free(entries);
    return 0;
}
