/* shared_objects.c OBJECT...: loads shared objects, each with a copy of the library, and prints the hash of the results of each. */
#include <dlfcn.h>
#include <inttypes.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; ++i) {
        void *object = dlopen(argv[i], RTLD_NOW | (i % 2 ? RTLD_GLOBAL : RTLD_LOCAL));
        uint64_t (*hash_of_all)(int);
        if (object == NULL || (*(void **)&hash_of_all = dlsym(object, "hash_of_all")) == NULL) {
            fprintf(stderr, "%s\n", dlerror());
            return 1;
        }
        printf("%016" PRIx64 "\n", hash_of_all(0));
    }
    return 0;
}
