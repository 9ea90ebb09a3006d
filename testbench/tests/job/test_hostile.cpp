// Text designed to break the reader: the result is always a job or a message.
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/tests/job/job_cases.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::Equals;
using Catch::StartsWith;

namespace {

/// Parses the text; any exception but InputError fails the test.
void survives(const std::string& text) {
    try {
        const Job job = parse_job(text, "hostile.toml");
        try {
            validate(job);
        } catch (const InputError&) {
        }
        REQUIRE(same_settings(parse_job(dump_job(job), "again.toml"), job));
    } catch (const InputError& error) {
        if (std::string(error.what()).find("hostile.toml:") != 0)
            FAIL("no file in: " << error.what());
    }
}

/// A dump without its comments, so that more of its bytes matter.
std::string bare_dump(const Job& job) {
    std::string bare;
    std::string dump = dump_job(job);
    while (!dump.empty()) {
        const std::string line = dump.substr(0, dump.find('\n') + 1);
        dump.erase(0, line.size());
        if (line[0] != '#' && line[0] != '\n')
            bare += line;
    }
    return bare;
}

}  // namespace

TEST_CASE("deep nesting of every kind ends in a message") {
    const auto repeated = [](const std::string& piece, std::size_t times) {
        std::string text;
        for (std::size_t i = 0; i < times; ++i)
            text += piece;
        return text;
    };
    CHECK_THAT(parse_error_of("a = " + repeated("[", 500000)), StartsWith("job.toml:1:"));
    CHECK_THAT(parse_error_of("a = " + repeated("{a=", 300000)), StartsWith("job.toml:1:"));
    CHECK_THAT(parse_error_of("a" + repeated(".a", 500000) + " = 1"), Contains("dots in one line; the limit is 64"));
    CHECK_THAT(parse_error_of("\n[a" + repeated(".a", 500000) + "]"), StartsWith("job.toml:2:1: "));
    CHECK_THAT(parse_error_of("[[a" + repeated(".a", 500000) + "]]"), Contains("dots in one line"));
    CHECK_THAT(parse_error_of(repeated("[[a]]\n", 100000)), Contains("unknown"));
    CHECK_THAT(parse_error_of(repeated("# ", 1000) + repeated(".", 1000)), Equals(""));
    // The deepest nesting within the line limit: 64 dots at each of toml++'s bracket levels.
    const std::string level = "a" + repeated(".a", 64) + " = [\n";
    for (const std::size_t levels : {1u, 7u, 8u, 15u, 16u, 17u, 64u}) {
        std::string text = level;
        for (std::size_t i = 1; i < levels; ++i)
            text += "{" + level;
        std::string closed = text;
        for (std::size_t i = 1; i < levels; ++i)
            closed += "]}";
        CHECK_THAT(parse_error_of(text), StartsWith("job.toml:"));
        CHECK_THAT(parse_error_of(closed + "]"), StartsWith("job.toml:"));
    }
    std::string many;
    for (int i = 0; i < 50000; ++i)
        many += "mesh_" + std::to_string(i) + " = 1\n";
    CHECK_THAT(parse_error_of(many), Contains("and 49980 more"));
}

TEST_CASE("hostile pieces of TOML are a job or an InputError") {
    const std::vector<std::string> pieces{"\xef\xbb\xbf",
                                          "\xff\xfe[\0m",
                                          "=",
                                          "[",
                                          "]",
                                          "[]",
                                          "[[]]",
                                          "[.]",
                                          "[mesh].",
                                          "\"",
                                          "'''",
                                          "\"\"\"",
                                          "a.",
                                          ".a=1",
                                          "a=\"\\ud800\"",
                                          "a=\"\\u\"",
                                          "a=0x",
                                          "a=0b2",
                                          "a=1__0",
                                          "a=+-1",
                                          "a=1e",
                                          "a=.5",
                                          "a=5.",
                                          "a=1979-13-01",
                                          "a=1979-02-30",
                                          "a=25:00:00",
                                          "a={,}",
                                          "a={b=1,}",
                                          "a=[,]",
                                          "a=[1 2]",
                                          "a=tru",
                                          "a=truex",
                                          "\r",
                                          "a=1\rb=2",
                                          "\x7f",
                                          "a='\x01'",
                                          "[mesh]\n[mesh.rows.x]",
                                          "mesh={rows=1}\n[mesh]\n",
                                          "mesh={rows=1}\nmesh.columns=2",
                                          "[mesh]\nrows.x=1\nrows.y=2",
                                          "[[mesh]]\n[mesh]",
                                          "[mesh]\n[[mesh]]",
                                          "mesh=[]\n[[mesh]]",
                                          "a=[{}]\n[[a]]",
                                          "a=-0",
                                          "mesh.rows=-0",
                                          "mesh.rows=+3",
                                          "mesh.rows=0x3",
                                          "mesh.rows=-9223372036854775808",
                                          "mesh.rows=9223372036854775808",
                                          "mesh.width=9223372036854775807",
                                          "camera.eye=[1,[2],3]",
                                          "camera.eye=[nan,inf,-inf]",
                                          "a=\"\xc0\x80\"",
                                          "a=\"\xed\xa0\x80\"",
                                          "\xc3",
                                          "a\xcc\x88=1",
                                          "\xc3\xa4=1",
                                          "map.text=\"\"\"\n\\\n  x\"\"\"",
                                          "map.text=\"\\U0010FFFF\"",
                                          "map.text=\"\\U00110000\"",
                                          "#\r\xc3\xa4=1",
                                          "#\v\xc3\xa4=1",
                                          "#\xe2\x80\xa8\xc3\xa4=1",
                                          "#\xc2\x85\xc3\xa4=1",
                                          "a='\\'\xc3\xa4",
                                          "a=\"\\\\\"\xc3\xa4",
                                          "a=\"\\\"\xc3\xa4",
                                          "a=1\xe2\x80\x83",
                                          "a=1'\xc3\xa4'",
                                          "a=1979-05-27 \n'\xc3\xa4'=1",
                                          "'\xc3\xa4'=1",
                                          "a=\"\"\"\\\n\xc3\xa4",
                                          "a='\r'\xc3\xa4",
                                          "a=1979-05-27T00:32:00.999999999999999999-07:00",
                                          "a=1979-05-27 07",
                                          "mode=\"functional\"\nmode=\"functional\""};
    for (const std::string& a : pieces) {
        survives(a);
        survives(std::string("\0", 1) + a);
        for (const std::string& b : pieces) {
            survives(a + b);
            survives(a + "\n" + b);
        }
    }
    CHECK(parse_job("\xef\xbb\xbf[mesh]\r\nrows = 5\r\n", "bom.toml").mesh.rows == 5);
}

TEST_CASE("a dumped job cut at every byte is a job or an InputError") {
    const std::string bare = bare_dump(Job{});
    for (std::size_t length = 0; length <= bare.size(); ++length)
        survives(bare.substr(0, length));
}

TEST_CASE("a dumped job with every byte changed is a job or an InputError") {
    const std::string bare = bare_dump(Job{});
    REQUIRE(same_settings(parse_job(bare, "bare.toml"), Job{}));
    for (std::size_t i = 0; i < bare.size(); ++i) {
        std::string changed = bare;
        // One bit each: the fuzzer changes more.
        changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ (1u << (i + i / 8) % 8));
        survives(changed);
        survives(bare.substr(0, i) + bare.substr(i + 1));
        survives(bare.substr(0, i) + bare.substr(i, 1) + bare.substr(i));
    }
}

TEST_CASE("characters beyond ASCII at every place are a job or an InputError") {
    const std::string bare = bare_dump(Job{}) + "# comment\n'a\"b' = 'c\"'\n\"d'\\\"\" = \"e'\\\\\"\n";
    for (const std::string character : {"\xc2\xa0", "\xc3\xa4", "\xe1\x9a\x80", "\xe2\x80\x83", "\xef\xbb\xbf",
                                        "\xe2\x80\xa8", "\xc2\x85", "\xf0\x9f\x98\x80", "\xff", "\xc3"})
        for (std::size_t i = 0; i <= bare.size(); ++i)
            survives(bare.substr(0, i) + character + bare.substr(i));
    CHECK(parse_job("# \xc3\xa4\n[map]\ntext = \"\xc3\xa4\" # \xc3\xa4\n", "job.toml").map.text == "\xc3\xa4");
    CHECK_THAT(parse_error_of("[map]\ntext = '\xc3\xa4' \xc3\xa4\n"), StartsWith("job.toml:2:12: not TOML"));
    CHECK(parse_job("map.text = \"\"\"\n\\\n \xc3\xa4\nb\"\"\"\n", "job.toml").map.text == "\xc3\xa4\nb");
}

TEST_CASE("error messages contain no control characters of a file") {
    CHECK_THAT(parse_error_of("a = f\x1b[31m\x07\n"), Contains("\\u001B[31m") || Contains("\\u001B"));
    for (const char c : parse_error_of("a = f\x1b[31m\x07\n"))
        CHECK(static_cast<unsigned char>(c) >= 0x20);
}

TEST_CASE("random bytes are a job or an InputError") {
    rc::prop("raw bytes", [] { survives(*rc::gen::arbitrary<std::string>()); });
    rc::prop("bytes that TOML uses", [] {
        survives(
            *rc::gen::container<std::string>(rc::gen::elementOf(std::string("[]{}=.,\"'\\#\n\r\t amesh01-+e_:TZx"))));
    });
}

TEST_CASE("a random setting sets its key or is an InputError") {
    rc::prop("any value", [] {
        const Key key = *rc::gen::elementOf(all_keys());
        const std::string value =
            *rc::gen::container<std::string>(rc::gen::elementOf(std::string("[]{}=.,\"'#\n\t 01-+e_:tru")));
        Job job;
        const std::string error = input_error_of([&] { apply_setting(job, key.name + "=" + value); });
        if (!error.empty()) {
            RC_ASSERT(error.rfind("--set " + key.name, 0) == 0);
            RC_ASSERT(same_settings(job, Job{}));
        }
        key.set(job, default_of(key));
        job.mesh.source = key.name == "mesh.file" ? Job{}.mesh.source : job.mesh.source;  // a file chooses it
        job.map.source = key.name == "map.file" ? Job{}.map.source : job.map.source;
        RC_ASSERT(same_settings(job, Job{}));
    });
}
