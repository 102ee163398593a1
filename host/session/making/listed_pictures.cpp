#include "session/making/listed_pictures.hpp"

#include <utility>

#include "capture/error.hpp"

namespace nutik {

void ListedPictures::add(const ExposureRequest& request, const OutputFormat& output, Done done) {
  done_.push_back(std::move(done));
  line_.add([this, request, output](const RenderControl& control) -> Made {
    try {
      return {session_.render(request, output, control), {}};
    } catch (const UsageError&) {
      return {std::nullopt, std::current_exception()};
    } catch (const InputError&) {
      return {std::nullopt, std::current_exception()};
    }
  });
  if (line_.is_full()) hand_on();
}

void ListedPictures::finish() {
  while (!line_.is_empty()) hand_on();
}

void ListedPictures::hand_on() {
  const Done done = std::move(done_.front());
  done_.pop_front();
  Made made = line_.take();
  done([&made] {
    if (made.error) std::rethrow_exception(made.error);
    return std::move(*made.exposed);
  });
}

}  // namespace nutik
