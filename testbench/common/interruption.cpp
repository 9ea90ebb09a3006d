#include "testbench/common/interruption.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace tessera {

namespace {

struct State {
    std::mutex mutex;  // held by a Delay, and permanently by the thread that ends the process
    std::vector<const Interruption::CleanUp*> clean_ups;
    std::atomic<bool> arrived{false};
    std::mutex note_mutex;
    std::string note;
};
State* state = new State;  // never destroyed: the thread outlives main(). A forked process has its own copy.

void write_line(int signal) {
    const char* const name = signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
    const std::lock_guard<std::mutex> lock(state->note_mutex);
    const std::string line =
        fmt::format("{}tessera: interrupted ({}){}{}; no unfinished file is left\n",
                    ::isatty(STDERR_FILENO) != 0 ? "\r\x1b[K" : "", name, state->note.empty() ? "" : " ", state->note);
    const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
    static_cast<void>(ignored);  // nothing more can be reported
}

void end_on_signal(sigset_t signals) {
    int signal = 0;
    if (::sigwait(&signals, &signal) != 0)
        return;
    state->arrived = true;
    state->mutex.lock();
    for (const Interruption::CleanUp* const clean_up : state->clean_ups)
        (*clean_up)();
    write_line(signal);
    std::signal(signal, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, signal);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    ::raise(signal);
}

void wait_for_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN)
            sigaddset(&signals, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    try {
        std::thread(end_on_signal, signals).detach();
    } catch (const std::system_error&) {
        // No thread available: a signal then has its default effect.
        ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    }
}

/// Blocks the calling thread once a signal has arrived.
void stop_if_arrived() {
    while (state->arrived)
        ::pause();
}

}  // namespace

void Interruption::expect() {
    wait_for_signals();
    ::pthread_atfork(nullptr, nullptr, [] {
        state = new State;
        wait_for_signals();
    });
}

void Interruption::note(std::string_view progress) {
    const std::lock_guard<std::mutex> lock(state->note_mutex);
    state->note = progress;
}

Interruption::Delay::Delay() : lock_(state->mutex) {}

Interruption::Delay::~Delay() {
    lock_.unlock();
    stop_if_arrived();
}

Interruption::CleanUp::CleanUp(std::function<void()> clean_up) : clean_up_(std::move(clean_up)) {
    const Delay delay;
    state->clean_ups.push_back(this);
}

Interruption::CleanUp::~CleanUp() {
    const Delay delay;
    auto& all = state->clean_ups;
    all.erase(std::remove(all.begin(), all.end(), this), all.end());
}

}  // namespace tessera
