// Kills a process at its N-th call that changes files in a folder: a library to preload (LD_PRELOAD).
//
//   KILL_FOLDER   the folder, absolute; calls elsewhere are not counted
//   KILL_AT       which call to kill at, from 1; 0: none
//   KILL_COUNT    a file for the number of calls, written at exit
//
// Before most calls the process dies instead of calling; of a write it first writes one half.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;

static int is_inside(const char *path) {
    const char *folder = getenv("KILL_FOLDER");
    return folder != NULL && path != NULL && strncmp(path, folder, strlen(folder)) == 0;
}

// Relative names count where the working directory is in the folder, or where they lead there from it.
static int names_inside(const char *path) {
    char whole[2 * PATH_MAX];
    if (path == NULL) return 0;
    if (path[0] == '/') return is_inside(path);
    if (getcwd(whole, PATH_MAX) == NULL) return 0;
    strcat(whole, "/");
    strncat(whole, path, PATH_MAX - 1);
    return is_inside(whole);
}

static int opens_inside(int descriptor) {
    char name[64], path[PATH_MAX];
    snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    const ssize_t size = readlink(name, path, sizeof path - 1);
    if (size <= 0) return 0;
    path[size] = 0;
    return is_inside(path);
}

// Returns whether this is the call to die at.
static int counts(int inside) {
    const char *at = getenv("KILL_AT");
    return inside && atomic_fetch_add(&calls, 1) + 1 == (at == NULL ? 0 : atol(at));
}

static void die(void) {
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define REPLACED(type, name, parameters, arguments, inside) \
    type name parameters {                                  \
        if (counts(inside)) die();                          \
        return NEXT(name) arguments;                        \
    }

REPLACED(int, rename, (const char *from, const char *to), (from, to), names_inside(to))
REPLACED(int, renameat, (int a, const char *from, int b, const char *to), (a, from, b, to), names_inside(to))
REPLACED(int, link, (const char *from, const char *to), (from, to), names_inside(to))
REPLACED(int, linkat, (int a, const char *from, int b, const char *to, int flags), (a, from, b, to, flags),
         names_inside(to))
REPLACED(int, unlink, (const char *path), (path), names_inside(path))
REPLACED(int, remove, (const char *path), (path), names_inside(path))
REPLACED(int, rmdir, (const char *path), (path), names_inside(path))
REPLACED(int, mkdir, (const char *path, mode_t mode), (path, mode), names_inside(path))
REPLACED(int, fsync, (int descriptor), (descriptor), opens_inside(descriptor))
REPLACED(int, ftruncate, (int descriptor, off_t size), (descriptor, size), opens_inside(descriptor))

ssize_t write(int descriptor, const void *bytes, size_t size) {
    if (counts(opens_inside(descriptor))) {
        (void)!NEXT(write)(descriptor, bytes, size / 2);
        die();
    }
    return NEXT(write)(descriptor, bytes, size);
}

ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t at) {
    if (counts(opens_inside(descriptor))) {
        (void)!NEXT(pwrite)(descriptor, bytes, size / 2, at);
        die();
    }
    return NEXT(pwrite)(descriptor, bytes, size, at);
}

__attribute__((destructor)) static void report(void) {
    const char *name = getenv("KILL_COUNT");
    FILE *file = name == NULL ? NULL : fopen(name, "w");
    if (file == NULL) return;
    fprintf(file, "%ld\n", atomic_load(&calls));
    fclose(file);
}
