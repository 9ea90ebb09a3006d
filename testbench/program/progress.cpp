#include "testbench/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "testbench/common/interruption.h"

namespace tessera {

Progress::Progress(std::string before)
    : before_(std::move(before)),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    clear();
}

void Progress::show(const std::string& what, double part) {
    std::array<char, 400> text{};
    const auto end =
        fmt::format_to_n(text.data(), text.size(), "at {:.0f} %, {}{}", 100 * part, before_, what);
    Interruption::note({text.data(), std::min(end.size, text.size())});
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now < next_)
        return;
    next_ = now + std::chrono::milliseconds(100);
    constexpr int width = 30;
    const int full = static_cast<int>(std::clamp(part, 0.0, 1.0) * width);
    fmt::print(stderr, "\r\x1b[K[{:=<{}}{: <{}}] {:3.0f} %  {}{}", "", full, "", width - full, 100 * part,
               before_, what);
    std::fflush(stderr);
    shown_ = true;
}

void Progress::clear() {
    Interruption::note({});
    if (!shown_)
        return;
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    shown_ = false;
}

}  // namespace tessera
