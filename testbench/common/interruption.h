#pragma once
#include <filesystem>
#include <string_view>

namespace tessera {

/// What a process leaves that is asked to end (Ctrl-C, SIGTERM, a terminal that closes): one line on standard
/// error that says how far it was, no unfinished file, and the same signal as its end, so that a shell or
/// script sees it.
class Interruption {
  public:
    /// From now on. A signal that is ignored already (nohup) stays ignored.
    static void expect();

    /// What the line will say of the work. At most 400 bytes are kept; cheap, and allocates nothing.
    static void note(std::string_view progress);

    /// While one lives, a signal waits: for what must not be left half done.
    class Delay {
      public:
        Delay();
        ~Delay();
        Delay(const Delay&) = delete;
        Delay& operator=(const Delay&) = delete;
    };
};

/// A file or a folder that goes away should the process be interrupted while this lives; a folder only if it is empty
/// by then. Nothing is removed by the destructor. More than 256 at a time, or a path beyond the system's limit, are not
/// looked after.
class Unfinished {
  public:
    explicit Unfinished(const std::filesystem::path& path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

  private:
    int place_ = -1;
};

}  // namespace tessera
