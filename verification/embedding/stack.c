/* stack.c: stack depth of each call, at most 16 kB, measured on a thread's stack that was filled with a pattern. The depth
   includes a few hundred bytes of the application, and some thousand when the linker resolves a function of the C library. */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "all_calls.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { SIZE = 1 << 20, PATTERN = 0xa5, LIMIT = 16 * 1024 };

static struct sequence sequence;
static mslip_element element;

static void *run(void *call)
{
    if (call != NULL) {
        make_call(&sequence, *(const size_t *)call);
    }
    return NULL;
}

/* Bytes of a thread's stack that were written. */
static size_t depth(size_t *call, unsigned char *stack)
{
    pthread_attr_t attributes;
    pthread_t thread;
    size_t untouched = 0;

    memset(stack, PATTERN, SIZE);
    if (pthread_attr_init(&attributes) != 0 || pthread_attr_setstack(&attributes, stack, SIZE) != 0
        || pthread_create(&thread, &attributes, run, call) != 0 || pthread_join(thread, NULL) != 0) {
        abort();
    }
    pthread_attr_destroy(&attributes);
    while (untouched < SIZE && stack[untouched] == PATTERN) {
        ++untouched;
    }
    return SIZE - untouched;
}

int main(void)
{
    unsigned char *stack = (unsigned char *)mmap(NULL, SIZE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) {
        abort();
    }
    const size_t thread = depth(NULL, stack);
    size_t failed = 0;

    begin_sequence(&sequence);
    for (size_t i = 0; i < number_of_calls; ++i) {
        size_t deepest = 0;
        for (int which = 0; which < CONTACTS; ++which) {
            mslip_contact contact;
            initialise(which, &contact, &element);
            sequence.contact = &contact;
            sequence.element = &element;
            const size_t taken = depth(&i, stack) - thread;
            deepest = taken > deepest ? taken : deepest;
        }
        failed += deepest > LIMIT;
        printf("%-28s %6zu bytes%s\n", calls[i], deepest, deepest > LIMIT ? ": exceeds the limit" : "");
    }
    end_sequence(&sequence);
    return failed != 0;
}
