#include "tools/lockstone/support/child_process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <chrono>
#include <csignal>
#include <thread>
#include <utility>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

// In the child, between fork and exec.
[[noreturn]] void become(char** arguments, pid_t parent) {
#if defined(__linux__)
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // it died before this took effect
#endif
  static_cast<void>(parent);
  setpgid(0, 0);  // out of the terminal's foreground group
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  execv("/proc/self/exe", arguments);
  _exit(127);
}

}  // namespace

ChildProcess ChildProcess::start(const std::vector<std::string>& arguments) {
  std::vector<std::string> copies{"lockstone"};
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& argument : copies)
    pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(pointers.data(), parent);
  return ChildProcess(pid);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, 0)) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) wait(0);
}

bool ChildProcess::poll(int& code) {
  int status = 0;
  const pid_t answer = waitpid(pid_, &status, WNOHANG);
  if (answer == 0) return false;
  code = answer < 0 ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  pid_ = 0;
  return true;
}

int ChildProcess::wait(double seconds) {
  using namespace std::chrono_literals;
  constexpr double k_grace_seconds = 1;
  if (pid_ <= 0) return -1;
  const Stopwatch watch;
  int signal_sent = 0;
  for (int code = 0;;) {
    if (poll(code)) return code;
    if (watch.seconds() > seconds && signal_sent == 0) kill(pid_, signal_sent = SIGTERM);
    if (watch.seconds() > seconds + k_grace_seconds && signal_sent == SIGTERM) {
      kill(pid_, signal_sent = SIGKILL);
    }
    std::this_thread::sleep_for(2ms);
  }
}

}  // namespace lockstone::tool
