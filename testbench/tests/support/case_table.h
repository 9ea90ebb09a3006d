#pragma once
#include <catch2/catch.hpp>
#include <functional>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tessera::testing {

/// A table of Catch2 cases: each row is a case named `prefix` and the row's `name`. For cases that cannot be sections
/// of one: SystemC elaborates once per process, and ctest runs each case in its own process.
template <class Row>
class CaseTable {
  public:
    CaseTable(const std::string& prefix, std::initializer_list<Row> rows, std::common_type_t<void (*)(const Row&)> run,
              const char* file = __builtin_FILE(), std::size_t line = __builtin_LINE())
        : CaseTable(prefix, std::vector<Row>(rows), run, file, line) {}
    CaseTable(const std::string& prefix, const std::vector<Row>& rows, std::common_type_t<void (*)(const Row&)> run,
              const char* file = __builtin_FILE(), std::size_t line = __builtin_LINE()) {
        for (const Row& row : rows)
            Catch::AutoReg(Invoker(new Case([=] { run(row); })), {file, line}, "", {prefix + row.name});
    }

  private:
#if CATCH_VERSION_MAJOR == 2
    using Invoker = Catch::ITestInvoker*;
#else
    using Invoker = Catch::Detail::unique_ptr<Catch::ITestInvoker>;
#endif
    struct Case : Catch::ITestInvoker {
        explicit Case(std::function<void()> its_run) : run(std::move(its_run)) {}
        void invoke() const override { run(); }
        std::function<void()> run;
    };
};

}  // namespace tessera::testing
