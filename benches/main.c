/* main.c: run time against error of microslip and of what one would use instead.
 *
 *   bench [--quick] rows DIRECTORY    writes rows.csv, the input of the multi-precision reference
 *   bench [--quick] run DIRECTORY     reads its output truth.csv, measures, and writes bench.csv, tables.md and details.md */
#include "cases.h"
#include "report.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double shapes[] = { 0.0, 0.3, 0.9, 0.999 }, amplitudes[] = { 0.01, 0.5, 0.95, 3.0 };
static const double quick_shapes[] = { 0.3, 0.9 }, quick_amplitudes[] = { 0.95 };
static const int orders[] = { 1, 5, 9 };

static const extent full = { .shapes = 4, .amplitudes = 4, .orders = 3, .shape = shapes, .amplitude = amplitudes,
    .order = orders, .least_samples = 16, .most_samples = 1024, .most_sliders = 4096, .most_contacts = 1000000 };
static const extent quick = { .shapes = 2, .amplitudes = 1, .orders = 3, .shape = quick_shapes, .amplitude = quick_amplitudes,
    .order = orders, .least_samples = 64, .most_samples = 128, .most_sliders = 1024, .most_contacts = 10000 };

static const struct { const char *name; task *task; double shape; } tasks[] = {
    { "force", task_force, -1.0 }, { "stiffness", task_stiffness, -1.0 }, { "harmonic force", task_harmonic, -1.0 },
    { "time step", task_time_step, -1.0 }, { "element", task_element, -1.0 }, { "batch", task_batch, 0.3 }, /* for one shape only */
    { "two directions", task_two_directions, 0.3 },
};

static FILE *open_file(const char *directory, const char *name, const char *mode)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, mode);
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

/* Processor, its caches, and the compiler. */
static const char *machine(void)
{
    static char text[512], model[128] = "unknown processor";
    FILE *info = fopen("/proc/cpuinfo", "r");
    while (info && fgets(text, sizeof text, info)) {
        if (sscanf(text, "model name : %127[^\n]", model) == 1) {
            break;
        }
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

static void run_tasks(const extent *x)
{
    for (int i = 0; i < x->shapes; ++i) {
        const size_t mark = memory_mark();
        const test_case c = case_of(x->shape[i]);
        for (size_t k = 0; k < sizeof tasks / sizeof *tasks; ++k) {
            if (tasks[k].shape < 0.0 || tasks[k].shape == c.shape) {
                fprintf(stderr, rounds ? "a/b = %g: %s\n" : "", c.shape, tasks[k].name);
                tasks[k].task(&c, x);
            }
        }
        free_to(mark);
    }
}

int main(int argc, char **argv)
{
    const int is_quick = argc > 1 && !strcmp(argv[1], "--quick");
    if (argc != 3 + is_quick || (strcmp(argv[argc - 2], "rows") && strcmp(argv[argc - 2], "run"))) {
        fprintf(stderr, "usage: %s [--quick] rows|run DIRECTORY\n", argv[0]);
        return 2;
    }
    const int run = !strcmp(argv[argc - 2], "run");
    const char *directory = argv[argc - 1];
    const extent *x = is_quick ? &quick : &full;
    truth_rows = open_file(directory, "rows.csv", run ? "r" : "w");
    if (!run) {
        rounds = 0;
        run_tasks(x);
        return fclose(truth_rows) != 0;
    }
    truth_values = open_file(directory, "truth.csv", "r");
    rounds = is_quick ? 7 : 15;
    run_tasks(x);
    check_errors();

    FILE *csv = open_file(directory, "bench.csv", "w"), *tables = open_file(directory, "tables.md", "w"),
         *details = open_file(directory, "details.md", "w");
    entries_write(csv);
    write_tables(tables, machine());
    write_tables(stdout, machine());
    write_details(details);
    write_details(stdout);
    fclose(csv);
    fclose(tables);
    fclose(details);
    free(entries);
    printf("\nerrors: %d passed, %d failed\n", checks_passed, checks_failed);
    return checks_failed > 0;
}
