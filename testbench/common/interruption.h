#pragma once
#include <functional>
#include <mutex>
#include <string_view>

namespace tessera {

/// Handles SIGINT, SIGTERM and SIGHUP: removes unfinished files, reports progress on one line of standard error, and
/// ends the process by the same signal. A thread waits for them with sigwait(), so all of this is ordinary code.
class Interruption {
  public:
    /// Installs the handling in this process and those it forks. Must be called first: every thread started later
    /// inherits the blocked signals, and so does a program started from here, unless it is given another mask. A signal
    /// that is already ignored (nohup) stays ignored.
    static void expect();

    /// Sets the progress text of that line.
    static void note(std::string_view progress);

    /// Defers signals while an object exists: for operations that must not be interrupted. Not recursive: a second one
    /// in the same thread deadlocks.
    class Delay {
      public:
        Delay();
        ~Delay();
        Delay(const Delay&) = delete;
        Delay& operator=(const Delay&) = delete;

      private:
        std::unique_lock<std::mutex> lock_;
    };

    /// Calls a function on a signal while the object exists; never during a Delay.
    class CleanUp {
      public:
        explicit CleanUp(std::function<void()> clean_up);
        ~CleanUp();
        CleanUp(const CleanUp&) = delete;
        CleanUp& operator=(const CleanUp&) = delete;

        void operator()() const { clean_up_(); }

      private:
        std::function<void()> clean_up_;
    };
};

}  // namespace tessera
