// Linked into every module in place of the library's pool of threads: a module has one thread, and
// no function that would make a pool. The library's own brings the texts of all system errors.
#include <cstdint>

#include <lockstone/thread_pool.h>

namespace lockstone {

struct ThreadPool::Impl {};

ThreadPool::ThreadPool(std::uint32_t) {}
ThreadPool::~ThreadPool() = default;
std::uint32_t ThreadPool::worker_count() const {
  return 1;
}
void ThreadPool::run(std::uint32_t chunks, TaskFunction task, void* context) {
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
    task(context, chunk, 0);
}

}  // namespace lockstone
