#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "testbench/commands/progress.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;

namespace {

using Clock = Progress::Clock;

Clock::time_point the_time;
Clock::time_point now() {
    return the_time;
}

/// The file to which progress is written, with a clock that the test sets.
class Log {
  public:
    explicit Log(bool terminal) : file_(std::tmpfile()), terminal_(terminal) {
        REQUIRE(file_ != nullptr);
        the_time = Clock::time_point{} + std::chrono::hours(1);
        begin_ = the_time;
    }
    ~Log() { std::fclose(file_); }
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;

    Progress::Display display() const { return {file_, terminal_, begin_, &now}; }
    void at(double seconds) const {
        the_time = begin_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
    std::string text() const {
        std::string text;
        std::rewind(file_);
        for (int c = 0; (c = std::fgetc(file_)) != EOF;)
            text += static_cast<char>(c);
        return text;
    }

  private:
    std::FILE* file_;
    bool terminal_;
    Clock::time_point begin_;
};

}  // namespace

TEST_CASE("progress in a log: one line every ten seconds, none for shorter work") {
    const Log log(false);
    Progress progress(log.display());
    progress.show("running", 0);
    log.at(9.999);
    progress.show("running", 0.4);
    progress.report_if_due();
    CHECK(log.text().empty());
    log.at(10);
    progress.show("running", 0.456);
    const std::string first = "tessera: after 10 s at 46 %, running\n";
    CHECK(log.text() == first);
    log.at(19.9);
    progress.show("running", 0.6);
    progress.report_if_due();
    CHECK(log.text() == first);
    // Without a call of show(), and late: one line at 47 s, none for 20, 30 and 40.
    log.at(47.5);
    progress.report_if_due();
    const std::string second = first + "tessera: after 47 s at 60 %, running\n";
    CHECK(log.text() == second);
    log.at(49);
    progress.show("checking", 0.9);
    CHECK(log.text() == second);
    log.at(50);
    progress.report_if_due();
    CHECK(log.text() == second + "tessera: after 50 s at 90 %, checking\n");
}

TEST_CASE("progress in a log: finished work is not shown, and work that begins late waits for its turn") {
    const Log log(false);
    log.at(35);
    {
        Progress progress(log.display());
        progress.show("measuring", 0.1);
        log.at(39);
        progress.show("measuring", 0.2);
        progress.clear();
        log.at(45);
        progress.report_if_due();
        CHECK(log.text().empty());
        progress.show("rendering", 0.3);
        CHECK(log.text().empty());  // nothing was printed at 40 s
        log.at(50);
    }
    Progress next(log.display());
    next.show("writing", 0);
    CHECK(log.text().empty());
    log.at(60);
    next.show("writing", 0.5);
    CHECK(log.text() == "tessera: after 60 s at 50 %, writing\n");
}

TEST_CASE("progress on a terminal: a bar is overwritten ten times a second, and no lines are printed") {
    const Log log(true);
    Progress progress(log.display());
    progress.show("running", 0.5);
    const std::string half = "\r\x1b[K[" + std::string(15, '=') + std::string(15, ' ') + "]  50 %  running";
    CHECK(log.text() == half);
    log.at(0.099);
    progress.show("running", 0.6);
    CHECK(log.text() == half);
    log.at(20);
    progress.report_if_due();
    CHECK(log.text() == half);
    progress.show("running", 1);
    const std::string all = half + "\r\x1b[K[" + std::string(30, '=') + "] 100 %  running";
    CHECK(log.text() == all);
    progress.clear();
    progress.clear();
    CHECK(log.text() == all + "\r\x1b[K");
}

TEST_CASE("progress that cannot be written raises no error") {
    std::FILE* const full = std::fopen("/dev/full", "w");
    REQUIRE(full != nullptr);
    the_time = Clock::time_point{} + std::chrono::hours(1);
    for (const bool terminal : {false, true}) {
        Progress progress({full, terminal, the_time, &now});
        the_time += std::chrono::seconds(25);
        CHECK_NOTHROW(progress.show("running", 0.5));
        CHECK_NOTHROW(progress.report_if_due());
        CHECK_NOTHROW(progress.clear());
    }
    std::fclose(full);
}

TEST_CASE("the program runner leaves out lines of progress and no others") {
    const TestFolder here;
    const ProgramEnd end = run_program({"sh", "-c",
                                        "echo 'tessera: note' >&2; echo 'tessera: after 20 s at 5 %, "
                                        "running' >&2; echo 'tessera: after all' >&2"},
                                       here.path());
    CHECK(end.err == "tessera: note\ntessera: after all\n");
}
