#include "testbench/output/trace/traces.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <ostream>
#include <streambuf>
#include <string_view>
#include <system_error>

#include "testbench/common/atomic_file.h"
#include "testbench/common/error.h"
#include "testbench/output/trace/recorder.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// A stream into an AtomicFile. An error stops the simulation and is stored, since an exception through SystemC would
/// lose its type.
class AtomicStream : private std::streambuf, public std::ostream {
  public:
    explicit AtomicStream(const fs::path& path) : std::ostream(nullptr), file_(path) { rdbuf(this); }

    void check() const {
        if (error_)
            std::rethrow_exception(error_);
    }
    void commit() {
        check();
        file_.commit();
    }

  private:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        if (!error_) {
            try {
                file_.write({bytes, static_cast<std::size_t>(count)});
                return count;
            } catch (...) {
                error_ = std::current_exception();
                sc_core::sc_stop();
            }
        }
        return 0;
    }
    std::streambuf::int_type overflow(std::streambuf::int_type c) override {
        const char byte = std::streambuf::traits_type::to_char_type(c);
        return xsputn(&byte, 1) == 1 ? c : std::streambuf::traits_type::eof();
    }

    AtomicFile file_;
    std::exception_ptr error_;
};

TraceWindow window_of(const Job& job) {
    return {static_cast<std::uint64_t>(job.output.trace_from), static_cast<std::uint64_t>(job.output.trace_to)};
}

std::string_view name_in_machine(const Unit& unit, const Machine& machine) {
    return std::string_view(unit.name()).substr(std::string_view(machine.name()).size() + 1);
}

}  // namespace

std::vector<const Unit*> units_to_trace(const std::string& words, const Machine& machine) {
    constexpr const char* separators = " ,\t\n";
    std::vector<const Unit*> chosen;
    const auto choose = [&](std::string_view word) {
        bool found = false;
        for (const Unit* unit : machine.units()) {
            if (name_in_machine(*unit, machine).find(word) == std::string_view::npos)
                continue;
            found = true;
            if (std::find(chosen.begin(), chosen.end(), unit) == chosen.end())
                chosen.push_back(unit);
        }
        if (found)
            return;
        std::string names;
        for (const Unit* unit : machine.units())
            names += fmt::format("{}{}", names.empty() ? "" : ", ", name_in_machine(*unit, machine));
        throw InputError(fmt::format("output.trace_units = \"{}\": no unit's name contains \"{}\"; the units are {}",
                                     words, word, names));
    };
    for (std::size_t begin = words.find_first_not_of(separators); begin != std::string::npos;) {
        const std::size_t end = std::min(words.find_first_of(separators, begin), words.size());
        choose(std::string_view(words).substr(begin, end - begin));
        begin = words.find_first_not_of(separators, end);
    }
    if (chosen.empty())
        chosen.assign(machine.units().begin(), machine.units().end());
    return chosen;
}

struct Traces::Files {
    Files(const Job& job, const fs::path& folder, Simulation& simulation, const std::vector<const Unit*>& units)
        : file(folder / "trace.vcd"),
          vcd(file, simulation.setup.design.timing.cycle_picoseconds, window_of(job)),
          recorder(simulation.machine, vcd, window_of(job), units) {}

    AtomicStream file;
    VcdWriter vcd;
    Recorder recorder;
};

Traces::Traces(const Job& job, const fs::path& folder, Simulation& simulation, const std::vector<const Unit*>& units)
    : files_(std::make_unique<Files>(job, folder, simulation, units)),
      simulation_(simulation),
      window_(window_of(job)) {}

Traces::~Traces() = default;

void Traces::check() const {
    files_->file.check();
}

void Traces::finish() {
    check();
    files_->recorder.finish(simulation_.cycles());
    files_->file.commit();
}

std::string Traces::text() const {
    const std::uint64_t cycles = simulation_.cycles();
    const std::string window =
        window_.first >= cycles
            ? fmt::format("the run ended after {} cycles, before cycle {}: only its end", cycles, window_.first)
            : fmt::format("cycles {} to {}", window_.first, std::min(window_.last, cycles - 1));
    return fmt::format("trace.vcd: {}, {} value changes", window, files_->vcd.changes());
}

std::string make_fst(const fs::path& folder, AtomicSet& files) {
    std::string program = "vcd2fst";
    std::string from = files.staged(folder / "trace.vcd").string();
    std::string to = files.staged(folder / "trace.fst").string();
    char* const arguments[] = {program.data(), from.data(), to.data(), nullptr};
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    // Signals blocked in this process would be blocked in the child too.
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, arguments[0], &actions, &attributes, arguments, environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT)
        return "no trace.fst: vcd2fst is not installed; it is in the package gtkwave (apt-get install "
               "gtkwave)";
    if (error != 0)
        return fmt::format("no trace.fst: vcd2fst cannot be started: {}", std::generic_category().message(error));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return WIFEXITED(status) && WEXITSTATUS(status) == 127
                   ? "no trace.fst: vcd2fst is not installed; it is in the package gtkwave (apt-get install "
                     "gtkwave)"
                   : fmt::format("no trace.fst: vcd2fst failed on {}", (folder / "trace.vcd").string());
    files.add(folder / "trace.fst");
    return {};
}

}  // namespace tessera
