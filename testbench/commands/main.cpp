#include <fmt/core.h>
#include <malloc.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <system_error>
#include <systemc>

#include "testbench/commands/command_line.h"
#include "testbench/commands/own_height_tests.h"
#include "testbench/common/error.h"
#include "testbench/common/interruption.h"

namespace {

int failed(tessera::ExitCode code, const char* message) {
    std::fflush(stdout);
    fmt::print(stderr, "tessera: {}\n", message);
    return static_cast<int>(code);
}

}  // namespace

int sc_main(int argc, char** argv) {
    using tessera::ExitCode;
    // Reaching a limit stops the simulation; SystemC would report that on standard output.
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    try {
        tessera::load_own_height_tests();
        const auto command = tessera::read_command_line(argc, argv);
        const ExitCode code = command ? command() : ExitCode::fine;
        // Output may still be buffered: a full disk may be detected only here.
        if (std::fflush(stdout) != 0)
            return failed(ExitCode::resource_limit,
                          fmt::format("standard output: {}", std::generic_category().message(errno)).c_str());
        return static_cast<int>(code);
    } catch (const tessera::InputError& error) {
        return failed(ExitCode::bad_input, error.what());
    } catch (const tessera::ResourceError& error) {
        return failed(ExitCode::resource_limit, error.what());
    } catch (const std::bad_alloc&) {
        return failed(ExitCode::resource_limit,
                      "out of memory; use a smaller map or raise the thresholds under [tests]");
    } catch (const std::system_error& error) {
        return failed(ExitCode::resource_limit, error.what());
    } catch (const sc_core::sc_report& report) {
        return failed(ExitCode::check_failed, report.what());
    } catch (const std::exception& error) {
        return failed(ExitCode::check_failed, error.what());
    }
}

// SystemC's own main() prints a banner.
int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    // A file beyond `ulimit -f` is then a write() error, which is reported and cleaned up.
    std::signal(SIGXFSZ, SIG_IGN);
    // Blocks of 1 MiB or more are returned to the system when freed; by default glibc raises this threshold to the size
    // of large blocks already freed.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    tessera::Interruption::expect();
    return sc_core::sc_elab_and_sim(argc, argv);
}
