// Preloaded into a program: makes its file operations fail, or sends it a signal between them.
//
// TESSERA_FAILING_DISK=N:WHAT does WHAT at the N-th call that opens for writing, writes, synchronises, renames or makes
// a folder: "full" (no space left: every write from then on fails), "error" (only that call fails), or the name of a
// signal, sent to the process before the call. TESSERA_DISK_LOG=FILE: receives the number of calls.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

template <typename Function>
Function* next(const char* name) {
    Function* function = nullptr;
    void* const symbol = dlsym(RTLD_NEXT, name);
    std::memcpy(&function, &symbol, sizeof function);
    return function;
}

struct Plan {
    long at = 0;
    const char* what = "";

    Plan() {
        if (const char* const text = std::getenv("TESSERA_FAILING_DISK")) {
            char* rest = nullptr;
            at = std::strtol(text, &rest, 10);
            what = rest + 1;
        }
    }
};

long calls = 0;

struct Log {
    ~Log() {
        if (const char* const name = std::getenv("TESSERA_DISK_LOG"))
            if (std::FILE* const file = std::fopen(name, "w")) {
                std::fprintf(file, "%ld\n", calls);
                std::fclose(file);
            }
    }
} log;

/// The error with which this call must fail, or 0.
int next_error(bool takes_space) {
    static const Plan plan;
    ++calls;
    if (std::strcmp(plan.what, "full") == 0)
        return takes_space && calls >= plan.at ? ENOSPC : 0;
    if (calls != plan.at)
        return 0;
    if (std::strcmp(plan.what, "error") == 0)
        return EIO;
    const int signal = std::strcmp(plan.what, "SIGINT") == 0    ? SIGINT
                       : std::strcmp(plan.what, "SIGTERM") == 0 ? SIGTERM
                                                                : SIGKILL;
    kill(getpid(), signal);
    usleep(100'000);  // for the thread that waits for the signal
    return 0;
}

bool fails(bool takes_space) {
    const int error = next_error(takes_space);
    if (error != 0)
        errno = error;
    return error != 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    static auto* const real = next<int(const char*, int, ...)>("open");
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    if ((flags & O_CREAT) != 0 && fails(true))
        return -1;
    return real(path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
    static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
    if (file > STDERR_FILENO && fails(true))
        return -1;
    return real(file, bytes, size);
}

int fsync(int file) {
    static auto* const real = next<int(int)>("fsync");
    return fails(false) ? -1 : real(file);
}

int rename(const char* from, const char* to) noexcept {
    static auto* const real = next<int(const char*, const char*)>("rename");
    return fails(false) ? -1 : real(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
    static auto* const real = next<int(const char*, mode_t)>("mkdir");
    return fails(true) ? -1 : real(path, mode);
}
}
