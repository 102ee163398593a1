#include "media/videos/damage_log.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <set>
#include <string_view>

#include "media/videos/libav.hpp"

namespace nutik::videos {
namespace {

// A decoder that fills parts of a picture says so by the picture's flags, too, but sets them too late for pictures that
// another thread hands out.
constexpr const char* kConcealing = "concealing ";
// What leading pictures give rise to.
constexpr const char* kMissingReferences[] = {"Missing reference picture", "reference picture missing during reorder",
                                              "co located POCs unavailable", kConcealing};

// FFmpeg has one log for a process, and decoders of other libraries write to it, too.
struct Listeners {
  std::mutex mutex;
  std::set<const void*> known;  // DamageLogs that live
};

Listeners& listeners() {
  static Listeners instance;
  return instance;
}

// The DamageLog of the decoder or the file on whose behalf a context logs; null where there is none.
void* log_of(const void* context) {
  while (context != nullptr) {
    const AVClass* kind = *static_cast<const AVClass* const*>(context);
    if (kind == nullptr) return nullptr;
    if (kind == avcodec_get_class()) return static_cast<const AVCodecContext*>(context)->opaque;
    if (kind == avformat_get_class()) return static_cast<const AVFormatContext*>(context)->opaque;
    if (kind->parent_log_context_offset == 0) return nullptr;
    context = *reinterpret_cast<const void* const*>(static_cast<const char*>(context) +
                                                    kind->parent_log_context_offset);
  }
  return nullptr;
}

void take_log(void* context, int level, const char* form, va_list values) {
  if (level > AV_LOG_ERROR && !std::string_view(form).starts_with(kConcealing)) return;
  void* const log = log_of(context);
  if (log == nullptr) return;
  char text[512];
  if (std::vsnprintf(text, sizeof text, form, values) <= 0) return;
  std::string said = text;
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.pop_back();
  const std::scoped_lock lock(listeners().mutex);
  if (listeners().known.contains(log)) static_cast<DamageLog*>(log)->note(said);
}

}  // namespace

void listen_to_ffmpeg() {
  av_log_set_level(AV_LOG_ERROR);
  av_log_set_callback(take_log);
}

DamageLog::~DamageLog() {
  const std::scoped_lock lock(listeners().mutex);
  listeners().known.erase(this);
}

void DamageLog::listen_to(void*& opaque) {
  const std::scoped_lock lock(listeners().mutex);
  listeners().known.insert(this);
  opaque = this;
}

void DamageLog::note(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  const auto is_of = [&](const char* missing) { return text.starts_with(missing); };
  if (!has_begun_ && is_of("mmco: unref short failure")) return;
  if (!has_begun_ && is_leading_ && std::ranges::any_of(kMissingReferences, is_of)) return;
  if (!first_) first_ = text;
}

std::optional<std::string> DamageLog::said() const {
  const std::scoped_lock lock(mutex_);
  return first_;
}

void DamageLog::forget() {
  const std::scoped_lock lock(mutex_);
  first_.reset();
}

}  // namespace nutik::videos
