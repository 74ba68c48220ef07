#include <algorithm>
#include <optional>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/replay/signature.h>

#include "replay/bytes/log_digest.h"
#include "replay/bytes/text.h"
#include "replay/chunks/chunk_reader.h"

#if defined(LOCKSTONE_WITH_SODIUM)
#include <sodium.h>
#endif

namespace lockstone::replay {
namespace {

constexpr std::size_t k_key_offset = 8;
constexpr std::size_t k_signature_offset = 40;

int digit_of(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  return letter >= 'A' && letter <= 'F' ? letter - 'A' + 10 : -1;
}

Status parse(std::string_view text, std::span<std::byte> bytes) {
  if (text.size() != 2 * bytes.size()) return Status::malformed;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int high = digit_of(text[2 * i]), low = digit_of(text[2 * i + 1]);
    if (high < 0 || low < 0) return Status::malformed;
    bytes[i] = static_cast<std::byte>(high * 16 + low);
  }
  return Status::ok;
}

// Reads a log in order and feeds every byte to the digest, up to where it is asked to.
class CoveredBytes {
 public:
  explicit CoveredBytes(Source& source) : source_(source), buffer_(1U << 16) {}

  Status advance_to(std::uint64_t offset) {
    while (done_ < offset) {
      const auto bytes =
          static_cast<std::size_t>(std::min<std::uint64_t>(offset - done_, buffer_.size()));
      const std::span<std::byte> piece = std::span(buffer_).first(bytes);
      if (source_.read_at(done_, piece) != Status::ok) return Status::io_error;
      digest_.update(piece);
      done_ += bytes;
    }
    return Status::ok;
  }
  [[nodiscard]] const LogDigest& digest() const { return digest_; }

 private:
  Source& source_;
  LogDigest digest_;
  std::vector<std::byte> buffer_;
  std::uint64_t done_ = 0;
};

// The state that one more signature leaves the report in.
SignatureState take_signature(ChunkReader& chunks, CoveredBytes& covered,
                              const std::optional<PublicKey>& expected, SignatureReport& report) {
  if (!signing_available()) return SignatureState::unchecked;
  const bool readable = chunks.read_payload() == Walk::good &&
                        chunks.payload().size() == k_signature_bytes &&
                        covered.advance_to(chunks.chunk_offset()) == Status::ok;
  if (!readable) return SignatureState::bad;
  const std::span<const std::byte, k_signature_bytes> payload(chunks.payload());
  const bool in_place = ByteReader(payload).get<std::uint64_t>() == chunks.chunk_offset();
  if (!in_place || !covered.digest().check(payload)) return SignatureState::bad;
  PublicKey key;
  std::copy_n(payload.begin() + k_key_offset, key.bytes.size(), key.bytes.begin());
  const PublicKey wanted = expected.value_or(report.signatures > 0 ? report.key : key);
  report.key = key;
  if (key != wanted) return SignatureState::foreign;
  ++report.signatures;
  report.covered_bytes = chunks.chunk_offset();
  return SignatureState::good;
}

}  // namespace

#if defined(LOCKSTONE_WITH_SODIUM)
namespace {

// Keeps these signatures apart from others of the same key.
constexpr std::string_view k_domain = "lockstone log 2.";
constexpr std::size_t k_digest_bytes = 32;
using Message = std::array<unsigned char, 16 + 8 + k_digest_bytes>;
static_assert(k_domain.size() == 16);

const unsigned char* raw(const std::byte* bytes) {
  return reinterpret_cast<const unsigned char*>(bytes);
}
unsigned char* raw(std::byte* bytes) {
  return reinterpret_cast<unsigned char*>(bytes);
}

bool start_library() {
  static const bool started = sodium_init() >= 0;
  return started;
}

}  // namespace

struct LogDigest::Parts {
  crypto_generichash_state state;
  std::uint64_t bytes = 0;

  [[nodiscard]] Message message() const {
    Message message{};
    std::copy(k_domain.begin(), k_domain.end(), message.begin());
    ByteWriter(std::as_writable_bytes(std::span(message)).subspan(k_domain.size(), 8)).put(bytes);
    crypto_generichash_state copy = state;  // finishing it ends it
    crypto_generichash_final(&copy, message.data() + k_domain.size() + 8, k_digest_bytes);
    return message;
  }
};

LogDigest::LogDigest() : parts_(std::make_unique<Parts>()) {
  if (!start_library()) misused("replay::LogDigest: libsodium did not start");
  crypto_generichash_init(&parts_->state, nullptr, 0, k_digest_bytes);
}

void LogDigest::update(ByteView bytes) {
  crypto_generichash_update(&parts_->state, raw(bytes.data()), bytes.size());
  parts_->bytes += bytes.size();
}

void LogDigest::sign(const SigningKey& key, std::span<std::byte, k_signature_bytes> payload) const {
  const Message message = parts_->message();
  ByteWriter writer(payload);
  writer.put(parts_->bytes);
  writer.put_bytes(key.public_key().bytes);
  crypto_sign_detached(raw(payload.data()) + k_signature_offset, nullptr, message.data(),
                       message.size(), raw(key.bytes.data()));
}

bool LogDigest::check(std::span<const std::byte, k_signature_bytes> payload) const {
  const Message message = parts_->message();
  return crypto_sign_verify_detached(raw(payload.data()) + k_signature_offset, message.data(),
                                     message.size(), raw(payload.data()) + k_key_offset) == 0;
}

bool signing_available() {
  return start_library();
}

Result<SigningKey> make_signing_key() {
  if (!start_library()) return Status::incompatible;
  SigningKey key;
  PublicKey ignored;
  crypto_sign_keypair(raw(ignored.bytes.data()), raw(key.bytes.data()));
  return key;
}
#else
struct LogDigest::Parts {};

LogDigest::LogDigest() = default;
void LogDigest::update(ByteView) {}
void LogDigest::sign(const SigningKey&, std::span<std::byte, k_signature_bytes>) const {
  misused("this build of lockstone::replay cannot sign: ask signing_available() first");
}
bool LogDigest::check(std::span<const std::byte, k_signature_bytes>) const {
  return false;
}

bool signing_available() {
  return false;
}

Result<SigningKey> make_signing_key() {
  return Status::incompatible;
}
#endif

LogDigest::~LogDigest() = default;

std::string PublicKey::to_text() const {
  return hex_digits(bytes);
}

Result<PublicKey> PublicKey::from_text(std::string_view text) {
  PublicKey key;
  if (const Status status = parse(text, key.bytes); status != Status::ok) return status;
  return key;
}

PublicKey SigningKey::public_key() const {
  PublicKey key;
  std::copy(bytes.begin() + 32, bytes.end(), key.bytes.begin());
  return key;
}

std::string SigningKey::to_text() const {
  return hex_digits(bytes);
}

Result<SigningKey> SigningKey::from_text(std::string_view text) {
  SigningKey key;
  if (const Status status = parse(text, key.bytes); status != Status::ok) return status;
  return key;
}

std::string_view to_string(SignatureState state) {
  switch (state) {
    case SignatureState::none:
      return "none";
    case SignatureState::good:
      return "good";
    case SignatureState::bad:
      return "bad";
    case SignatureState::foreign:
      return "foreign";
    case SignatureState::unchecked:
      return "unchecked";
  }
  return "unknown";
}

SignatureReport check_signatures(Source& source, const std::optional<PublicKey>& expected) {
  SignatureReport report;
  ChunkReader chunks(source);
  if (chunks.open() != Walk::good) return report;
  CoveredBytes covered(source);
  bool ended = false;
  std::uint64_t ticks = 0;
  Walk walk = chunks.next_frame();
  for (; walk == Walk::good; walk = chunks.next_frame()) {
    const ChunkHeader& chunk = chunks.chunk();
    if (ended && (report.covers_end || chunk.type != ChunkType::signature)) break;
    ended = ended || chunk.type == ChunkType::end;
    if (chunk.type == ChunkType::hash) ticks += chunk.count;
    if (chunk.type != ChunkType::signature) continue;
    report.state = take_signature(chunks, covered, expected, report);
    if (report.state != SignatureState::good) return report;
    report.covered_ticks = ticks;
    report.covers_end = ended;
  }
  // One signature may follow the END, and nothing else: it does not cover bytes behind it.
  if (ended && walk != Walk::finished && report.state == SignatureState::good) {
    report.state = SignatureState::bad;
    report.covers_end = false;
  }
  return report;
}

}  // namespace lockstone::replay
