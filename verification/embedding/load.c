/* load.c OBJECT...: each shared object has a copy of the library in it and answers alike. */
#define _GNU_SOURCE /* RTLD_DEEPBIND */
#include <dlfcn.h>
#include <inttypes.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; ++i) {
        void *object = dlopen(argv[i], RTLD_NOW | (i % 2 ? RTLD_GLOBAL : RTLD_LOCAL));
        uint64_t (*visit_all)(void);
        if (object == NULL || (*(void **)&visit_all = dlsym(object, "visit_all")) == NULL) {
            fprintf(stderr, "%s\n", dlerror());
            return 1;
        }
        printf("%016" PRIx64 "\n", visit_all());
    }
    return 0;
}
