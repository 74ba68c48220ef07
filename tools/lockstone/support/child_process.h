// Child processes of the demo: this program again, with other arguments.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace lockstone::tool {

/// One child. It does not outlive this process, and Ctrl-C at the terminal does not reach it: the
/// parent decides when it ends.
class ChildProcess {
 public:
  /// Runs this program with `arguments`; its standard output goes nowhere.
  [[nodiscard]] static ChildProcess start(const std::vector<std::string>& arguments);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();  ///< ends it, if it still runs

  [[nodiscard]] bool started() const { return pid_ > 0; }

  /// Waits for its end, up to `seconds`, then ends it. The exit code, 128 + signal, or −1.
  int wait(double seconds);

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  [[nodiscard]] bool poll(int& code);

  pid_t pid_;
};

}  // namespace lockstone::tool
