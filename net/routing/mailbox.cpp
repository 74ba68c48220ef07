#include "net/routing/mailbox.h"

#include <cstring>
#include <type_traits>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

static_assert(std::is_trivially_copyable_v<Parcel>);

}  // namespace

Mailbox::Mailbox(std::size_t capacity) : capacity_(capacity) {
  written_.bytes.reset(new std::byte[capacity]);
  read_.bytes.reset(new std::byte[capacity]);
}

bool Mailbox::put(const Parcel& parcel, ByteView bytes, std::size_t spare) {
  LKS_ASSERT(parcel.size == bytes.size());
  const std::lock_guard lock(mutex_);
  const std::size_t room = capacity_ - written_.used;
  const std::size_t reserved = (1 + spare) * sizeof(Parcel);
  if (room < reserved || room - reserved < bytes.size()) return false;
  std::byte* place = written_.bytes.get() + written_.used;
  std::memcpy(place, &parcel, sizeof(Parcel));
  if (!bytes.empty()) std::memcpy(place + sizeof(Parcel), bytes.data(), bytes.size());
  written_.used += sizeof(Parcel) + bytes.size();
  waiting_.store(true, std::memory_order_release);
  return true;
}

bool Mailbox::take(Parcel& parcel, ByteView& bytes) {
  if (position_ == read_.used) {
    if (!waiting_.load(std::memory_order_acquire)) return false;
    read_.used = 0;
    position_ = 0;
    const std::lock_guard lock(mutex_);
    std::swap(written_, read_);
    waiting_.store(false, std::memory_order_relaxed);
  }
  const std::byte* place = read_.bytes.get() + position_;
  std::memcpy(&parcel, place, sizeof(Parcel));
  LKS_ASSERT(position_ + sizeof(Parcel) + parcel.size <= read_.used);
  bytes = ByteView(place + sizeof(Parcel), parcel.size);
  position_ += sizeof(Parcel) + parcel.size;
  return true;
}

void Mailbox::clear() {
  const std::lock_guard lock(mutex_);
  written_.used = read_.used = position_ = 0;
  waiting_.store(false, std::memory_order_relaxed);
}

}  // namespace lockstone::net
