// The pictures of a video's stream as libavcodec hands them out, one after another in the order in which they are
// shown.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "media/videos/libav.hpp"

namespace nutik::videos {

class PictureDecoder {
 public:
  // Where times are wanted, the pictures are worth nothing: what only makes them look right is left out, and so are
  // those that cannot be decoded.
  enum class Wanted { pictures, times };

  // Which of the stream's packets are decoded: where a file was cut, its first ones may refer to pictures that it
  // lacks, and its last may not be whole.
  struct Packets {
    std::uint64_t first = 0, end = UINT64_MAX;
  };

  // Throws InputError naming the file where no decoder knows its pictures.
  PictureDecoder(OpenedVideo opened, std::string name, Wanted wanted, const Packets& packets, int threads);

  [[nodiscard]] const AVStream& stream() const { return *opened_.format->streams[opened_.stream]; }

  // That it uses, as many as were asked for at most.
  [[nodiscard]] int threads() const { return codec_->thread_count; }

  // False at the end. Throws InputError where the file is damaged so that a wanted picture is none.
  bool next(AVFrame& picture);

  // Passes over a picture that no other refers to, before the first next(): its packet is not decoded. False at the
  // end. Throws InputError where pictures before it are missing.
  bool skip();

  // What its decoder has said of damage so far: of the picture that came last, or of one soon after it.
  [[nodiscard]] std::optional<std::string> damage() const { return damage_->said(); }

 private:
  void feed();
  // Whether the packet that was read last is to be decoded; counts it.
  bool takes_packet();
  [[noreturn]] void fail(int code) const;
  [[noreturn]] void fail_at_hole() const;

  std::string name_;
  OpenedVideo opened_;
  std::unique_ptr<DamageLog> damage_ = std::make_unique<DamageLog>();  // outlives the decoder
  CodecPointer codec_;
  PacketPointer packet_;
  Wanted wanted_;
  Packets packets_;
  std::uint64_t packets_read_ = 0;
  std::uint64_t pictures_ = 0;
  std::int64_t first_shown_ = AV_NOPTS_VALUE;  // when the first packet's picture is
  bool has_begun_ = false;  // a packet was taken
  bool has_hole_ = false;   // and is decoded up to there
};

}  // namespace nutik::videos
