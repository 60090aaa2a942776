/* stack.c: the deepest stack that each call takes, measured on a stack that was painted before. The host's part, which
   allocates and hashes, is a few hundred bytes of it; finding a function of the C library for the first time, some thousand. */
#define _GNU_SOURCE
#include "use.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { SIZE = 1 << 20, PAINT = 0xa5 };

struct task {
    void (*make)(struct visit *);
    struct visit visit;
};

static void *run(void *data)
{
    struct task *task = (struct task *)data;
    if (task->make != NULL) {
        task->make(&task->visit);
    }
    return NULL;
}

/* Bytes of a thread's stack that were written to. */
static size_t depth(struct task *task, unsigned char *stack)
{
    pthread_attr_t attributes;
    pthread_t thread;
    size_t untouched = 0;

    memset(stack, PAINT, SIZE);
    if (pthread_attr_init(&attributes) != 0 || pthread_attr_setstack(&attributes, stack, SIZE) != 0
        || pthread_create(&thread, &attributes, run, task) != 0 || pthread_join(thread, NULL) != 0) {
        abort();
    }
    pthread_attr_destroy(&attributes);
    while (untouched < SIZE && stack[untouched] == PAINT) {
        ++untouched;
    }
    return SIZE - untouched;
}

int main(void)
{
    struct task task = { NULL, { NULL, { workspace(MSLIP_UNIFORM_SAMPLING), workspace(MSLIP_EVENT_DRIVEN) }, 0 } };
    unsigned char *stack = (unsigned char *)mmap(NULL, SIZE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) {
        abort();
    }
    const size_t thread = depth(&task, stack);
    size_t passed = 0;

    for (size_t i = 0; i < number_of_calls; ++i) {
        const size_t limit = 1024 * calls[i].kilobytes;
        size_t deepest = 0;
        for (int which = 0; which < CONTACTS; ++which) {
            mslip_contact contact;
            initialise(which, &contact);
            task.visit.contact = &contact;
            task.make = calls[i].make;
            const size_t taken = depth(&task, stack) - thread;
            deepest = taken > deepest ? taken : deepest;
        }
        passed += deepest <= limit;
        printf("%-42s %6zu bytes%s\n", calls[i].name, deepest, deepest <= limit ? "" : ": too many");
    }
    free(task.visit.workspace[0]);
    free(task.visit.workspace[1]);
    munmap(stack, SIZE);
    printf("%zu passed, %zu failed\n", passed, number_of_calls - passed);
    return passed != number_of_calls;
}
