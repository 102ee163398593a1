// Pictures of a list, each of which may be wrong by itself: what is wrong with one stops no other.
//
//   in:      exposures of one session, one after another
//   out:     each handed to its Done, in that order, while others may be made
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <optional>

#include "session/making/picture_line.hpp"
#include "session/session.hpp"

namespace nutik {

// Tells what is wrong with one picture, and goes on.
template <typename Work, typename Tell>
void unless_wrong(const Work& work, const Tell& tell) {
  try {
    work();
  } catch (const UsageError& error) {
    tell(error);
  } catch (const InputError& error) {
    tell(error);
  }
}

class ListedPictures {
 public:
  // Returns the picture, once; or throws UsageError or InputError, which say what is wrong with this one.
  using Take = std::function<ExposedPicture()>;
  using Done = std::function<void(const Take& take)>;

  // No picture of the `count` has wider values than these.
  ListedPictures(Session& session, ValueType widest, std::size_t count)
      : session_(session), line_(session.pictures_at_once(widest, count)) {}

  // Hands on a picture where enough are being made. Throws what ends the list: DeviceError, Interrupted …
  void add(const ExposureRequest& request, const OutputFormat& output, Done done);
  void finish();

 private:
  struct Made {
    std::optional<ExposedPicture> exposed;
    std::exception_ptr error;
  };
  void hand_on();

  Session& session_;
  std::deque<Done> done_;  // of those in line
  PictureLine<Made> line_;
};

}  // namespace nutik
