/* process.c: what belongs to the process of the host is after all calls as it was before. */
#define _GNU_SOURCE
#include "use.h"

#include <dirent.h>
#include <errno.h>
#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static int passed, failed;

static void check(int holds, const char *what)
{
    ++*(holds ? &passed : &failed);
    printf("%s: %s\n", holds ? "unchanged" : "CHANGED", what);
}

enum { SIGNALS = 65 };
struct process {
    struct sigaction actions[SIGNALS];
    sigset_t mask;
    stack_t signal_stack;
    char locale[256];
    int files, error, rounding, traps;
};

static void handler(int number)
{
    (void)number;
}

static int open_files(void)
{
    DIR *directory = opendir("/proc/self/fd");
    int files = 0;
    while (directory != NULL && readdir(directory) != NULL) {
        ++files;
    }
    if (directory != NULL) {
        closedir(directory);
    }
    return files;
}

/* errno first: looking changes it. */
static void look(struct process *p)
{
    p->error = errno;
    for (int i = 1; i < SIGNALS; ++i) {
        sigaction(i, NULL, &p->actions[i]);
    }
    sigprocmask(SIG_BLOCK, NULL, &p->mask);
    sigaltstack(NULL, &p->signal_stack);
    snprintf(p->locale, sizeof p->locale, "%s", setlocale(LC_ALL, NULL));
    p->files = open_files();
    p->rounding = fegetround();
    p->traps = fegetexcept();
}

static int same_actions(const struct process *p, const struct process *q)
{
    for (int i = 1; i < SIGNALS; ++i) {
        if (p->actions[i].sa_handler != q->actions[i].sa_handler || p->actions[i].sa_flags != q->actions[i].sa_flags) {
            return 0;
        }
    }
    return 1;
}

/* With traps, in a locale, with a handler and an error that are not those of a fresh process. */
int main(void)
{
    static struct process before, after;
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = handler;
    sigaction(SIGFPE, &action, NULL);
    sigaction(SIGSEGV, &action, NULL);
    setlocale(LC_ALL, "C.UTF-8");
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    const uint64_t expected = visit_all();

    look(&before);
    errno = ERANGE;
    const uint64_t again = visit_all();
    look(&after);
    check(after.error == ERANGE, "errno");
    check(same_actions(&before, &after), "signal handlers");
    check(memcmp(&before.mask, &after.mask, sizeof before.mask) == 0, "signal mask");
    check(memcmp(&before.signal_stack, &after.signal_stack, sizeof before.signal_stack) == 0, "signal stack");
    check(strcmp(before.locale, after.locale) == 0, "locale");
    check(before.files == after.files, "open files");
    check(before.traps == after.traps && after.traps == (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), "traps");
    check(before.rounding == after.rounding, "rounding to nearest");
    check(expected == again, "answers");

    /* Whatever is computed in another rounding mode, the mode stays. */
    static const int modes[] = { FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
    for (size_t i = 0; i < sizeof modes / sizeof *modes; ++i) {
        fesetround(modes[i]);
        visit_all();
        check(fegetround() == modes[i], "another rounding mode");
        fesetround(FE_TONEAREST);
    }
    check(visit_all() == expected, "answers after other rounding modes");

    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
