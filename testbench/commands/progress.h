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

/// Says how far long work is. On a terminal: one line that is overwritten. Elsewhere, in a log: a line at every tenth
/// second since the program began, whether or not show() is called there, and so none for shorter work. An Interruption
/// says it too.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;
    /// Where it is said, and the time.
    struct Display {
        std::FILE* file;
        bool terminal;
        Clock::time_point begin;  ///< of the program
        Clock::time_point (*now)();
    };

    /// On standard error. `before`: what every line says first.
    explicit Progress(std::string before = {});
    /// Elsewhere; no line is written but by show() and say_if_due().
    Progress(std::string before, const Display& display);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// part: 0..1 of the work done. Shown on a terminal at most ten times a second.
    void show(const std::string& what, double part);
    void clear();

    /// Not on a terminal: writes the line if it is time for it.
    void say_if_due();

  private:
    /// Whole tens of seconds since the program began.
    std::int64_t tens() const;
    std::string_view text() const { return {text_.data(), text_size_}; }
    void say_if_due_locked();
    void show_on_terminal(const std::string& what, double part);
    void begin_to_say();
    void write(const std::string& text);
    void say_until_stopped();

    std::string before_;
    Display display_;
    bool shown_ = false;
    Clock::time_point next_;

    std::mutex mutex_;              // for what is below
    std::array<char, 400> text_{};  // what show() said last
    std::size_t text_size_ = 0;     // 0: nothing since clear()
    std::int64_t said_;             // tens of seconds for which no line is due any more
    bool stopped_ = false;
    std::condition_variable stop_;
    std::thread speaker_;
};

}  // namespace tessera
