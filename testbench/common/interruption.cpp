#include "testbench/common/interruption.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <system_error>

namespace tessera {

namespace {

// The handler may call little (signal-safety(7)) and come between any two instructions: so fixed places, and
// a flag that is set when a place is complete.
struct Place {
    std::atomic<bool> taken{false};
    std::atomic<bool> complete{false};
    std::array<char, PATH_MAX> path{};
};
std::array<Place, 256> places;

struct Note {
    std::array<char, 400> text{};
    std::size_t size = 0;
};
std::array<Note, 2> notes;  // one is written while the other holds
std::atomic<std::size_t> current_note{0};

std::atomic<int> delays{0};
std::atomic<int> waiting_signal{0};
pthread_t main_thread;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<std::size_t>::is_always_lock_free);

void remove_unfinished() {
    std::size_t folders = 0;
    for (Place& place : places)
        if (place.complete && ::unlink(place.path.data()) != 0 && errno == EISDIR)
            ++folders;
    // Inner ones first, wherever they stand.
    for (; folders > 0; --folders)
        for (Place& place : places)
            if (place.complete)
                ::rmdir(place.path.data());
}

const char* name_of(int signal) {
    return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

/// A line put together without allocating, and written at once.
class Line {
  public:
    void add(const char* text, std::size_t size) {
        size = std::min(size, text_.size() - size_);
        std::memcpy(text_.data() + size_, text, size);
        size_ += size;
    }
    void add(const char* text) { add(text, std::strlen(text)); }
    void write() const {
        const ssize_t ignored = ::write(STDERR_FILENO, text_.data(), size_);
        static_cast<void>(ignored);  // there is nobody left to tell
    }

  private:
    std::array<char, 600> text_;
    std::size_t size_ = 0;
};

void write_line(int signal) {
    Line line;
    if (::isatty(STDERR_FILENO) != 0)
        line.add("\r\x1b[K");
    line.add("tessera: interrupted (");
    line.add(name_of(signal));
    line.add(")");
    const Note& note = notes[current_note];
    if (note.size > 0) {
        line.add(" ");
        line.add(note.text.data(), note.size);
    }
    line.add("; no unfinished file is left\n");
    line.write();
}

void end_by(int signal) {
    remove_unfinished();
    write_line(signal);
    std::signal(signal, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, signal);
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    std::raise(signal);
}

void handle(int signal) {
    const int error = errno;
    if (pthread_equal(pthread_self(), main_thread) == 0)
        pthread_kill(main_thread, signal);  // the thread that writes must not go on beside this
    else if (delays > 0)
        waiting_signal = signal;
    else
        end_by(signal);
    errno = error;
}

}  // namespace

void Interruption::expect() {
    main_thread = pthread_self();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN)
            continue;
        struct sigaction ours {};
        ours.sa_handler = handle;
        ours.sa_flags = SA_RESTART;
        sigfillset(&ours.sa_mask);
        ::sigaction(signal, &ours, nullptr);
    }
}

void Interruption::note(std::string_view progress) {
    const std::size_t next = 1 - current_note;
    Note& note = notes[next];
    note.size = std::min(progress.size(), note.text.size());
    std::copy_n(progress.data(), note.size, note.text.data());
    current_note = next;
}

Interruption::Delay::Delay() {
    ++delays;
}

Interruption::Delay::~Delay() {
    if (--delays > 0)
        return;
    if (const int signal = waiting_signal.exchange(0))
        std::raise(signal);
}

Unfinished::Unfinished(const std::filesystem::path& path) {
    // The working folder may be another by then.
    std::error_code error;
    const std::string text = std::filesystem::absolute(path, error).string();
    if (error || text.size() >= PATH_MAX)
        return;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i].taken.exchange(true))
            continue;
        std::memcpy(places[i].path.data(), text.c_str(), text.size() + 1);
        places[i].complete = true;
        place_ = static_cast<int>(i);
        return;
    }
}

Unfinished::~Unfinished() {
    if (place_ < 0)
        return;
    Place& place = places[static_cast<std::size_t>(place_)];
    place.complete = false;
    place.taken = false;
}

}  // namespace tessera
