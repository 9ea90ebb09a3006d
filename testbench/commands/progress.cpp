#include "testbench/commands/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "testbench/common/interruption.h"

namespace tessera {

namespace {

constexpr std::chrono::seconds between_lines{10};
const Progress::Clock::time_point program_began = Progress::Clock::now();

}  // namespace

Progress::Progress() : Progress({stderr, isatty(STDERR_FILENO) != 0, program_began, &Progress::Clock::now}) {
    if (!display_.terminal)
        begin_to_say();
}

Progress::Progress(const Display& display) : display_(display), next_(display.now()), reported_(tens()) {}

Progress::~Progress() {
    clear();
    if (!reporter_.joinable())
        return;
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
    }
    stop_.notify_one();
    reporter_.join();
}

std::int64_t Progress::tens() const {
    return (display_.now() - display_.begin) / between_lines;
}

void Progress::begin_to_say() {
    try {
        reporter_ = std::thread([this] { report_until_stopped(); });
    } catch (const std::system_error&) {
        // No thread can be started: only show() reports.
    }
}

/// A log that cannot be written must not end a run; fmt::print would throw in the thread and in the destructor.
void Progress::write(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), display_.file);
    std::fflush(display_.file);
}

void Progress::report_until_stopped() {
    std::unique_lock lock(mutex_);
    while (!stop_.wait_until(lock, display_.begin + (reported_ + 1) * between_lines, [&] { return stopped_; }))
        report_if_due_locked();
}

void Progress::report_if_due() {
    const std::lock_guard lock(mutex_);
    report_if_due_locked();
}

void Progress::report_if_due_locked() {
    const std::int64_t now = tens();
    if (display_.terminal || now <= reported_)
        return;
    reported_ = now;
    if (text_size_ == 0)
        return;
    const auto elapsed = std::chrono::duration_cast<std::chrono::seconds>(display_.now() - display_.begin).count();
    write(fmt::format("tessera: after {} s {}\n", elapsed, text()));
}

void Progress::show(const std::string& what, double part) {
    const std::lock_guard lock(mutex_);
    const auto end = fmt::format_to_n(text_.data(), text_.size(), "at {:.0f} %, {}", 100 * part, what);
    text_size_ = std::min(end.size, text_.size());
    Interruption::note(text());
    report_if_due_locked();
    if (display_.terminal)
        show_on_terminal(what, part);
}

void Progress::show_on_terminal(const std::string& what, double part) {
    const Clock::time_point now = display_.now();
    if (now < next_)
        return;
    next_ = now + std::chrono::milliseconds(100);
    constexpr int width = 30;
    const int full = static_cast<int>(std::clamp(part, 0.0, 1.0) * width);
    write(fmt::format("\r\x1b[K[{:=<{}}{: <{}}] {:3.0f} %  {}", "", full, "", width - full, 100 * part, what));
    shown_ = true;
}

void Progress::clear() {
    Interruption::note({});
    const std::lock_guard lock(mutex_);
    text_size_ = 0;
    if (!shown_)
        return;
    write("\r\x1b[K");
    shown_ = false;
}

}  // namespace tessera
