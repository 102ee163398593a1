// What FFmpeg says of damage. Many decoders only log it, conceal what is missing with what was there before, and hand
// out a picture that seems whole; containers' readers go on behind it, and pictures are gone.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

namespace nutik::videos {

// From now on what decoders and containers log goes to their DamageLog, and nothing of it to standard error. Once is
// enough.
void listen_to_ffmpeg();

// Listens to one decoder or one opened file, and outlives it. Their threads write, whoever reads pictures asks.
class DamageLog {
 public:
  DamageLog() = default;
  ~DamageLog();
  DamageLog(const DamageLog&) = delete;
  DamageLog& operator=(const DamageLog&) = delete;

  // `opaque` of a decoder, which must not be open yet (its threads have copies of it), or of a file.
  void listen_to(void*& opaque);

  void note(const std::string& text);
  // The first that was said since the start or since forget().
  [[nodiscard]] std::optional<std::string> said() const;
  void forget();
  // Before the first picture that is shown, H.264 tells of pictures that lie before a cut: that those to be dropped are
  // missing, and that leading pictures, which nobody sees, refer to them. Neither damages a picture that is shown.
  void expect_leading() { is_leading_ = true; }
  void begin() { has_begun_ = true; }

 private:
  mutable std::mutex mutex_;
  std::optional<std::string> first_;
  std::atomic<bool> has_begun_ = false, is_leading_ = false;
};

}  // namespace nutik::videos
