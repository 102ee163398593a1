// What FFmpeg's decoders say of damage. Many only log it, conceal what is missing with what was there before, and hand
// out a picture that seems whole.
#pragma once

#include <mutex>
#include <optional>
#include <string>

struct AVCodecContext;

namespace nutik::videos {

// From now on what decoders log goes to their DamageLog, and nothing of it to standard error. Once is enough.
void listen_to_ffmpeg();

// Of one decoder, which it outlives. Its threads write, whoever reads pictures asks.
class DamageLog {
 public:
  DamageLog() = default;
  ~DamageLog();
  DamageLog(const DamageLog&) = delete;
  DamageLog& operator=(const DamageLog&) = delete;

  // Of a decoder that is not open yet: threads have copies of it.
  void listen_to(AVCodecContext& decoder);

  void note(const std::string& text);
  // The first that was said since the start or since forget().
  [[nodiscard]] std::optional<std::string> said() const;
  void forget();

 private:
  mutable std::mutex mutex_;
  std::optional<std::string> first_;
};

}  // namespace nutik::videos
