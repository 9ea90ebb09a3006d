#pragma once
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace tessera {

/// Reports the progress of long work. On a terminal: one line that is overwritten. In a log: one line every ten seconds
/// since the program began, even without further calls of show(); none for shorter work. An Interruption reports it
/// too.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;
    /// Where progress is shown, and the clock.
    struct Display {
        std::FILE* file;
        bool terminal;
        Clock::time_point begin;  ///< of the program
        Clock::time_point (*now)();
    };

    /// On standard error.
    Progress();
    /// On another display; lines are written by show() and report_if_due() only.
    explicit Progress(const Display& display);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// part: fraction of the work done, 0..1. A terminal is updated at most ten times per second.
    void show(const std::string& what, double part);
    void clear();

    /// In a log: writes a line if one is due.
    void report_if_due();

  private:
    /// Whole tens of seconds since the program began.
    std::int64_t tens() const;
    std::string_view text() const { return {text_.data(), text_size_}; }
    void report_if_due_locked();
    void show_on_terminal(const std::string& what, double part);
    void begin_to_say();
    void write(const std::string& text);
    void report_until_stopped();

    Display display_;
    bool shown_ = false;
    Clock::time_point next_;

    std::mutex mutex_;              // guards the members below
    std::array<char, 400> text_{};  // last text given to show()
    std::size_t text_size_ = 0;     // 0: no text since clear()
    std::int64_t reported_;         // the last ten-second mark for which no line is due any more
    bool stopped_ = false;
    std::condition_variable stop_;
    std::thread reporter_;
};

}  // namespace tessera
