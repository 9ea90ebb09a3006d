#pragma once
#include <chrono>
#include <string>

namespace tessera {

/// One line on a terminal that is overwritten as work goes on; silent where standard error is not a terminal. An
/// Interruption says it too.
class Progress {
  public:
    /// `before`: what every line says first.
    explicit Progress(std::string before = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// part: 0..1 of the work done. Shown at most ten times a second.
    void show(const std::string& what, double part);
    void clear();

  private:
    std::string before_;
    bool terminal_;
    bool shown_ = false;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace tessera
