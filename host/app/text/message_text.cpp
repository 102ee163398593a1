#include "app/text/message_text.hpp"

#include "capture/format.hpp"
#include "session/clip_source.hpp"
#include "session/memory_budget.hpp"

namespace nutik::app {

std::string message_text(const std::exception& error) {
  const std::string message = error.what();
  if (const auto* pictures = dynamic_cast<const PicturesTooLarge*>(&error)) {
    return format("{}; allow more: --memory {}MB", message, pictures->least_bytes / 1'000'000 + 1);
  }
  if (const auto* blocks = dynamic_cast<const BlocksTooLong*>(&error)) {
    return format("{} (--memory); use fewer samples a block (--block-samples {})", message,
                  blocks->most_samples);
  }
  if (dynamic_cast<const ExposuresAreListed*>(&error) != nullptr) {
    return message + "; leave --shutter-angle out, or the exposure_ns column empty";
  }
  return message;
}

}  // namespace nutik::app
