// A bar on standard error where somebody looks, and Ctrl-C as a question.
#pragma once

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>

namespace fpc::tool {

inline constexpr int kInterrupted = 130;  ///< exit code after Ctrl-C

inline std::atomic<bool>& interruption() {
  static std::atomic<bool> asked{false};
  return asked;
}

/// From now on Ctrl-C is kept for interruption() to tell.
inline void catchInterrupts() {
  interruption() = false;  // made before a handler may touch it
  std::signal(SIGINT, [](int) { interruption() = true; });
}

class ProgressBar {
 public:
  explicit ProgressBar(std::string name)
      : name_(std::move(name)), shown_(isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (shown_ && percent_ >= 0) std::fprintf(stderr, "\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// share 0..1; `stage` is redrawn only when the percentage moves.
  void show(double share, const std::string& stage = "") {
    const auto percent = static_cast<int>(100.0 * share);
    if (!shown_ || percent == percent_) return;
    percent_ = percent;
    const std::string bar(static_cast<std::size_t>(percent) / 4, '#');
    std::fprintf(stderr, "\r%s [%-25s] %3d %% %s\033[K", name_.c_str(), bar.c_str(), percent,
                 stage.c_str());
  }

 private:
  std::string name_;
  bool shown_;
  int percent_{-1};
};

}  // namespace fpc::tool
