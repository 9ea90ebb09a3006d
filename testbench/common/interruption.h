#pragma once
#include <functional>
#include <mutex>
#include <string_view>

namespace tessera {

/// Handles SIGINT, SIGTERM and SIGHUP: removes unfinished files, reports progress on one line of standard error, and
/// ends the process by the same signal. A thread waits for them with sigwait(), so all of this is ordinary code.
class Interruption {
  public:
    /// From now on, in this process and those it forks. To be called first: every thread started later inherits the
    /// blocked signals, and so does a program that is started, unless it is given another mask. A signal that is
    /// ignored already (nohup) stays ignored.
    static void expect();

    /// What the line will say of the work.
    static void note(std::string_view progress);

    /// While one lives, a signal waits: for what must not be left half done. Not recursive: a second one in the same
    /// thread deadlocks.
    class Delay {
      public:
        Delay();
        ~Delay();
        Delay(const Delay&) = delete;
        Delay& operator=(const Delay&) = delete;

      private:
        std::unique_lock<std::mutex> lock_;
    };

    /// Called on a signal while this lives; never while a Delay lives.
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
