#include "testbench/common/pipe.h"

#include <unistd.h>

#include <array>
#include <cerrno>

namespace tessera {

void write_to_pipe(int pipe, const void* data, std::size_t size) {
    const char* next = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(pipe, next, size);
        if (written < 0)
            return;
        next += written;
        size -= static_cast<std::size_t>(written);
    }
}

std::string read_from_pipe(int pipe) {
    std::string text;
    std::array<char, 4096> some{};
    for (;;) {
        const ssize_t count = ::read(pipe, some.data(), some.size());
        if (count > 0)
            text.append(some.data(), static_cast<std::size_t>(count));
        else if (count == 0 || errno != EINTR)
            return text;
    }
}

}  // namespace tessera
