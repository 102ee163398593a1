// Makes a series: exposures of one capture, each in a file of its own, which is written while the next is exposed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "features/series/picture_queue.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/session.hpp"

namespace nutik {

struct SeriesPicture {
  StatedTime start;
  std::filesystem::path path;
  std::uint64_t number = 0;  // in the series
};

// `exposure` says all but where each begins. `add`, which may be empty, is told each picture as it was exposed, and
// returns the text that goes into its file. Throws what Session::render() does; OutputError at the first picture that
// cannot be written: the next ones are not exposed.
void make_series(Session& session, ExposureRequest exposure, const std::vector<SeriesPicture>& pictures,
                 const OutputFormat& output, const FileWishes& file, const ReportedProgress& progress,
                 const std::function<std::string(std::uint64_t number, ExposedPicture& exposed)>& add);

// Tells what is wrong with one picture, and goes on.
template <typename Work, typename Tell>
void unless_wrong(const Work& work, const Tell& tell) {
  try {
    work();
  } catch (const UsageError& error) {
    tell(error);
  } catch (const InputError& error) {
    tell(error);
  } catch (const ImpreciseError& error) {
    tell(error);
  }
}

// Pictures of a list, each of which may be wrong by itself: what is wrong with one stops no other.
//
//   in:      exposures of one session, one after another
//   out:     each handed to its Done, in that order, while others may be made
class ListedPictures {
 public:
  // Returns the picture, once; or throws UsageError, InputError or ImpreciseError, which say what is wrong with this
  // one.
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

// Whether `picture` is there with the very recipe, byte for byte, that `recipe_of` makes for its precision: the same
// capture, functions, mask, options and version of the program. `precision`: the only one that counts; none: any, for
// `auto` is settled when a picture is computed. What carries no recipe, or cannot be read, is not made yet, nor without
// `map`, which its recipe must name; empty: with a map or without.
[[nodiscard]] bool is_made(const std::filesystem::path& picture, const std::optional<std::string>& precision,
                           const std::filesystem::path& map,
                           const std::function<std::string(const std::string& precision)>& recipe_of);

}  // namespace nutik
