#include "media/videos/picture_decoder.hpp"

#include <utility>

#include "media/videos/phantom_file.hpp"

namespace nutik::videos {

PictureDecoder::PictureDecoder(OpenedVideo opened, std::string name, Wanted wanted, const Packets& packets,
                               int threads)
    : name_(std::move(name)),
      opened_(std::move(opened)),
      packet_(allocated(av_packet_alloc())),
      wanted_(wanted),
      packets_(packets) {
  const AVCodecParameters& parameters = *stream().codecpar;
  const AVCodec* decoder = avcodec_find_decoder(parameters.codec_id);
  if (decoder == nullptr) throw InputError(format("{}: no decoder here knows its pictures", name_));
  codec_.reset(allocated(avcodec_alloc_context3(decoder)));
  codec_->thread_count = threads;
  codec_->err_recognition = AV_EF_CRCCHECK;
  // Else a slice that cannot be parsed leaves the picture as it was, without a word.
  if (parameters.codec_id == AV_CODEC_ID_HEVC) codec_->err_recognition |= AV_EF_EXPLODE;
  if (wanted == Wanted::times) codec_->skip_loop_filter = codec_->skip_idct = AVDISCARD_ALL;
  codec_->pkt_timebase = stream().time_base;
  damage_->listen_to(codec_->opaque);
  const int code = avcodec_parameters_to_context(codec_.get(), &parameters);
  codec_->max_pixels = most_pixels(parameters).value_or(codec_->max_pixels);
  // Some files give the depth of what the table makes of them.
  if (is_phantom_packed(parameters)) codec_->bits_per_coded_sample = kPhantomPackedBits;
  if (code < 0 || avcodec_open2(codec_.get(), decoder, nullptr) < 0) {
    throw InputError(format("{}: its decoder cannot be started", name_));
  }
}

bool PictureDecoder::next(AVFrame& picture) {
  for (;;) {
    const int code = avcodec_receive_frame(codec_.get(), &picture);
    if (code == AVERROR_EOF) {
      if (has_hole_) fail_at_hole();
      return false;
    }
    if (code == 0) {
      damage_->begin();
      ++pictures_;
      return true;
    }
    if (code != AVERROR(EAGAIN) && wanted_ == Wanted::pictures) fail(code);
    feed();
  }
}

bool PictureDecoder::skip() {
  for (bool is_picture = false; !is_picture; av_packet_unref(packet_.get())) {
    if (av_read_frame(opened_.format.get(), packet_.get()) < 0) return false;
    if (!has_begun_) opened_.log->forget();
    if (opened_.log->said()) fail_at_hole();  // and what comes next is another picture than it is counted as
    // What an edit list leaves out is no picture, nor is an empty slot.
    is_picture = takes_packet() && packet_->size > 0 && (packet_->flags & AV_PKT_FLAG_DISCARD) == 0;
  }
  has_begun_ = true;
  ++pictures_;
  return true;
}

bool PictureDecoder::takes_packet() {
  if (packet_->stream_index != opened_.stream) return false;
  const std::uint64_t number = packets_read_++;
  return number >= packets_.first && number < packets_.end;
}

void PictureDecoder::feed() {
  for (;;) {
    if (av_read_frame(opened_.format.get(), packet_.get()) < 0) {
      avcodec_send_packet(codec_.get(), nullptr);
      return;
    }
    // What the container's reader did not understand lies before this packet: it went on behind that. If nothing comes
    // any more the clip was cut off, which its length tells; if nothing came before, its start was.
    if (!has_begun_) opened_.log->forget();
    has_hole_ = opened_.log->said() && wanted_ == Wanted::pictures;
    if (has_hole_) {
      av_packet_unref(packet_.get());
      avcodec_send_packet(codec_.get(), nullptr);
      return;
    }
    const bool is_wanted = takes_packet();
    if (is_wanted && !has_begun_) first_shown_ = packet_->pts;
    const bool is_hidden = (packet_->flags & AV_PKT_FLAG_DISCARD) != 0;
    if (is_wanted && (is_hidden || packet_->pts < first_shown_)) damage_->expect_leading();
    const int code = is_wanted ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
    has_begun_ |= is_wanted && code >= 0;
    av_packet_unref(packet_.get());
    // A clip that was cut starts with packets that refer to pictures before it.
    const bool is_cut = code == AVERROR_INVALIDDATA && pictures_ == 0;
    if (code < 0 && !is_cut && wanted_ == Wanted::pictures) fail(code);
    if (is_cut) damage_->forget();
    if (is_wanted) return;
  }
}

void PictureDecoder::fail_at_hole() const {
  throw InputError(
      format("{}: pictures are missing behind the first {}, for the file is damaged there "
             "(FFmpeg says: {})",
             name_, pictures_, *opened_.log->said()));
}

void PictureDecoder::fail(int code) const {
  throw InputError(format("{}: picture {} cannot be decoded: {}", name_, pictures_, error_text(code)));
}

}  // namespace nutik::videos
