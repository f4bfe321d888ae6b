// Ends a program at its k-th call that changes files, or has that call fail. The program loads this first (LD_PRELOAD).
//   KILL_IN     folder, absolute and without links: calls on paths in it, and on itself, are counted
//   KILL_CALLS  names of the calls that count, of: rename unlink rmdir mkdir open write close sync; `open` is that for writing
//   KILL_AT     number of the call, from 1
//   KILL_WHEN   `before` the call or `after` it; `half`: a write is done by half before; a number: the call fails with that errno
//   KILL_LOG    file that gets a line for each call that counts
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static atomic_long calls;

// The path of a file descriptor; empty for none.
static void path_of(int fd, char out[PATH_MAX]) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    long length = syscall(SYS_readlinkat, AT_FDCWD, link, out, PATH_MAX - 1);
    out[length > 0 ? length : 0] = 0;
}

// Makes a path absolute.
static void resolve(int folder, const char *path, char out[PATH_MAX]) {
    if (path[0] == '/') {
        snprintf(out, PATH_MAX, "%s", path);
        return;
    }
    char base[PATH_MAX];
    if (folder == AT_FDCWD) {
        if (!getcwd(base, sizeof base)) base[0] = 0;
    } else {
        path_of(folder, base);
    }
    if ((size_t)snprintf(out, PATH_MAX, "%s/%s", base, path) >= PATH_MAX) out[0] = 0;
}

static int is_in(const char *path) {
    const char *folder = getenv("KILL_IN");
    size_t length = folder ? strlen(folder) : 0;
    return length && !strncmp(path, folder, length) && (path[length] == '/' || !path[length]);
}

// Whether this call is the one; it is counted if it counts.
static int is_the_one(const char *call, const char *path) {
    const char *names = getenv("KILL_CALLS"), *at = getenv("KILL_AT"), *log = getenv("KILL_LOG");
    if (!names || !strstr(names, call) || !is_in(path)) return 0;
    long number = ++calls;
    if (log) {
        char line[PATH_MAX + 64];
        int length = snprintf(line, sizeof line, "%ld %s %s\n", number, call, path);
        long fd = syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0666);
        if (fd >= 0) {
            syscall(SYS_write, fd, line, length);
            syscall(SYS_close, fd);
        }
    }
    return at && number == atol(at);
}

static void end(void) {
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

static const char *when(void) {
    const char *when = getenv("KILL_WHEN");
    return when ? when : "before";
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

// Does a call, unless it is the one at which the program ends or which fails.
#define CALL(kind, path, real)                     \
    do {                                           \
        int one = is_the_one(kind, path);          \
        if (one && atoi(when())) {                 \
            errno = atoi(when());                  \
            return -1;                             \
        }                                          \
        if (one && strcmp(when(), "after")) end(); \
        __typeof__(real) result = real;            \
        if (one) end();                            \
        return result;                             \
    } while (0)

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    char path[PATH_MAX];
    resolve(to_folder, to, path);
    CALL("rename", path, REAL(renameat2)(from_folder, from, to_folder, to, flags));
}
int renameat(int from_folder, const char *from, int to_folder, const char *to) {
    char path[PATH_MAX];
    resolve(to_folder, to, path);
    CALL("rename", path, REAL(renameat)(from_folder, from, to_folder, to));
}
int rename(const char *from, const char *to) {
    char path[PATH_MAX];
    resolve(AT_FDCWD, to, path);
    CALL("rename", path, REAL(rename)(from, to));
}
int unlink(const char *name) {
    char path[PATH_MAX];
    resolve(AT_FDCWD, name, path);
    CALL("unlink", path, REAL(unlink)(name));
}
int rmdir(const char *name) {
    char path[PATH_MAX];
    resolve(AT_FDCWD, name, path);
    CALL("rmdir", path, REAL(rmdir)(name));
}
int unlinkat(int folder, const char *name, int flags) {
    char path[PATH_MAX];
    resolve(folder, name, path);
    CALL(flags & AT_REMOVEDIR ? "rmdir" : "unlink", path, REAL(unlinkat)(folder, name, flags));
}
int mkdir(const char *name, mode_t mode) {
    char path[PATH_MAX];
    resolve(AT_FDCWD, name, path);
    CALL("mkdir", path, REAL(mkdir)(name, mode));
}
int fsync(int fd) {
    char path[PATH_MAX];
    path_of(fd, path);
    CALL("sync", path, REAL(fsync)(fd));
}
int fdatasync(int fd) {
    char path[PATH_MAX];
    path_of(fd, path);
    CALL("sync", path, REAL(fdatasync)(fd));
}
ssize_t write(int fd, const void *bytes, size_t count) {
    char path[PATH_MAX];
    path_of(fd, path);
    if (!strcmp(when(), "half") && is_the_one("write", path)) {
        syscall(SYS_write, fd, bytes, count / 2);
        end();
    }
    CALL("write", path, REAL(write)(fd, bytes, count));
}
int close(int fd) {
    int flags = fcntl(fd, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) return REAL(close)(fd);
    char path[PATH_MAX];
    path_of(fd, path);
    CALL("close", path, REAL(close)(fd));
}

// Opening: the mode is there where a file may be made.
#define MODE(flags)                          \
    mode_t mode = 0;                         \
    if (flags & (O_CREAT | O_TMPFILE)) {     \
        va_list rest;                        \
        va_start(rest, flags);               \
        mode = va_arg(rest, mode_t);         \
        va_end(rest);                        \
    }
#define OPEN(folder, name, real)                          \
    if ((flags & O_ACCMODE) == O_RDONLY) return real;     \
    char path[PATH_MAX];                                  \
    resolve(folder, name, path);                          \
    CALL("open", path, real)

int open(const char *name, int flags, ...) {
    MODE(flags)
    OPEN(AT_FDCWD, name, REAL(open)(name, flags, mode));
}
int open64(const char *name, int flags, ...) {
    MODE(flags)
    OPEN(AT_FDCWD, name, REAL(open64)(name, flags, mode));
}
int openat(int folder, const char *name, int flags, ...) {
    MODE(flags)
    OPEN(folder, name, REAL(openat)(folder, name, flags, mode));
}
int openat64(int folder, const char *name, int flags, ...) {
    MODE(flags)
    OPEN(folder, name, REAL(openat64)(folder, name, flags, mode));
}
