// The program's functions for memory. Where the library holds its own C++ runtime, all of its
// memory comes through the operators below, which no other part of the program sees.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include "tools/bindings/c/call.h"

#if defined(LOCKSTONE_OWN_RUNTIME)

namespace {

struct Allocator {
  lks_allocate_function allocate = nullptr;
  lks_release_function release = nullptr;
  void* user = nullptr;
};

/// In front of each block: how to give it back.
struct Header {
  void* memory;
  const Allocator* from;
  std::size_t bytes;  ///< of `memory`
  std::size_t alignment;
};

constexpr std::size_t k_least_alignment = 16;
static_assert(sizeof(Header) % k_least_alignment == 0);

void* allocate_by_malloc(void*, std::size_t bytes, std::size_t alignment) {
  return alignment <= k_least_alignment ? std::malloc(bytes) : std::aligned_alloc(alignment, bytes);
}

void release_by_free(void*, void* memory, std::size_t, std::size_t) {
  std::free(memory);
}

constexpr Allocator k_malloc{allocate_by_malloc, release_by_free, nullptr};

// Blocks point to the allocator that they came from: earlier ones stay, and few are ever set.
std::atomic<const Allocator*> current{&k_malloc};

std::size_t round_up(std::size_t value, std::size_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

void* take_memory(std::size_t bytes, std::size_t wanted_alignment) noexcept {
  const std::size_t alignment = std::max(wanted_alignment, k_least_alignment);
  const std::size_t front = round_up(sizeof(Header), alignment);
  if (bytes > SIZE_MAX / 2 || alignment > SIZE_MAX / 4) return nullptr;
  const std::size_t whole = round_up(front + bytes, alignment);
  const Allocator* from = current.load(std::memory_order_acquire);
  void* memory = from->allocate(from->user, whole, alignment);
  if (memory == nullptr) return nullptr;
  std::byte* block = static_cast<std::byte*>(memory) + front;
  new (block - sizeof(Header)) Header{memory, from, whole, alignment};
  return block;
}

void give_back(void* block) noexcept {
  if (block == nullptr) return;
  const Header header = *reinterpret_cast<Header*>(static_cast<std::byte*>(block) - sizeof(Header));
  header.from->release(header.from->user, header.memory, header.bytes, header.alignment);
}

void* take_or_throw(std::size_t bytes, std::size_t alignment) {
  void* block = take_memory(bytes, alignment);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

}  // namespace

void* operator new(std::size_t bytes) {
  return take_or_throw(bytes, k_least_alignment);
}
void* operator new[](std::size_t bytes) {
  return take_or_throw(bytes, k_least_alignment);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return take_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return take_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return take_memory(bytes, k_least_alignment);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return take_memory(bytes, k_least_alignment);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return take_memory(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
  return take_memory(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept {
  give_back(block);
}
void operator delete[](void* block) noexcept {
  give_back(block);
}
void operator delete(void* block, std::size_t) noexcept {
  give_back(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  give_back(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  give_back(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
  give_back(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  give_back(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
  give_back(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  give_back(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
  give_back(block);
}
void operator delete(void* block, std::align_val_t, const std::nothrow_t&) noexcept {
  give_back(block);
}
void operator delete[](void* block, std::align_val_t, const std::nothrow_t&) noexcept {
  give_back(block);
}

lks_status lks_set_allocator(lks_allocate_function allocate, lks_release_function release,
                             void* user) {
  return lockstone::c::call([&] {
    if ((allocate == nullptr) != (release == nullptr))
      lockstone::c::throw_status(LKS_NULL_ARGUMENT, "one of the two functions is null");
    if (allocate == nullptr) {
      current.store(&k_malloc, std::memory_order_release);
      return;
    }
    auto* memory = static_cast<Allocator*>(std::malloc(sizeof(Allocator)));
    if (memory == nullptr) throw std::bad_alloc();
    current.store(new (memory) Allocator{allocate, release, user}, std::memory_order_release);
  });
}

#else

lks_status lks_set_allocator(lks_allocate_function, lks_release_function, void*) {
  return lockstone::c::call([] {
    lockstone::c::throw_status(LKS_UNSUPPORTED, "this build takes memory from its C++ runtime");
  });
}

#endif
