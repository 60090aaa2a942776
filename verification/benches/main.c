/* main.c: run time against error of microslip and of the spring-sliders that one would use instead.
 *
 *   bench [--quick] DIRECTORY    measures, and writes bench.csv and tables.md */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

static const double shapes[] = { 0.0, 0.3, 0.9, 0.999 }, amplitudes[] = { 0.01, 0.5, 0.95, 3.0 };

static const extent full = { .shapes = 4, .amplitudes = 4, .shape = shapes, .amplitude = amplitudes, .least_samples = 16,
    .most_samples = 1024, .most_sliders = 4096 };
static const extent quick = { .shapes = 2, .amplitudes = 1, .shape = shapes + 1, .amplitude = amplitudes + 2, .least_samples = 64,
    .most_samples = 128, .most_sliders = 1024 };

/* A new task is a line here and its set-up. */
enum { AMPLITUDES = -1, AMPLITUDES_AND_HARMONICS = -2 };
static const struct { const char *name; set_up *set_up; int cases, one_shape; } tasks[] = {
    { "initialisation", set_up_initialisation, 1, 0 },
    { "harmonic force", set_up_harmonic, AMPLITUDES_AND_HARMONICS, 0 },
    { "time step", set_up_step, AMPLITUDES, 0 },
    { "element", set_up_element, 1, 0 },
    { "face", set_up_face, 1, 0 },
    { "two directions", set_up_plane, 2, 1 },
};

static void run_tasks(const extent *x)
{
    const int numbers[] = { 0, x->amplitudes, 3 * x->amplitudes };
    for (int i = 0; i < x->shapes; ++i) {
        const size_t mark = memory_mark();
        const test_case c = case_of(x->shape[i]);
        for (size_t t = 0; t < sizeof tasks / sizeof *tasks; ++t) {
            const int cases = tasks[t].cases < 0 ? numbers[-tasks[t].cases] : tasks[t].cases;
            for (int k = 0; k < cases && (!tasks[t].one_shape || c.shape == 0.3); ++k) {
                const size_t first = entry_count, task_mark = memory_mark();
                tasks[t].set_up(&c, x, k);
                for (entry *e = entries + first; e < entries + entry_count; ++e) {
                    e->shape = c.shape;
                }
                measure(first);
                free_to(task_mark);
            }
            fprintf(stderr, "a/b = %g: %s\n", c.shape, tasks[t].name);
        }
        free_to(mark);
    }
}

int main(int argc, char **argv)
{
    const int is_quick = argc > 1 && !strcmp(argv[1], "--quick");
    if (argc != 2 + is_quick) {
        fprintf(stderr, "usage: %s [--quick] DIRECTORY\n", argv[0]);
        return 2;
    }
    rounds = is_quick ? 7 : 15;
    run_tasks(is_quick ? &quick : &full);
    static const struct { const char *name; void (*write)(FILE *); } files[] = {
        { "bench.csv", write_entries }, { "tables.md", write_tables } };
    for (int k = 0; k < 2; ++k) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", argv[argc - 1], files[k].name);
        FILE *file = fopen(path, "w");
        if (!file) {
            perror(path);
            return 1;
        }
        files[k].write(file);
        fclose(file);
    }
    return 0;
}
