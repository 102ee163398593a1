#include "studio/live/room_watch.hpp"

#include <limits>
#include <utility>

#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/text/size_text.hpp"

namespace nutik::studio {
namespace {

// Before so many bytes were written others on the same disk tell more about it than this capture.
constexpr std::uint64_t kMinTaken = 16'000'000;

std::uint64_t left_in(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return error ? std::numeric_limits<std::uint64_t>::max() : space.available;
}

}  // namespace

RoomWatch::RoomWatch(std::filesystem::path folder)
    : RoomWatch(folder, [folder] { return left_in(folder); }) {}

RoomWatch::RoomWatch(std::filesystem::path folder, Left left)
    : folder_(std::move(folder)), left_(std::move(left)), at_first_(left_()) {}

void RoomWatch::look(std::uint64_t done, std::uint64_t total) const {
  const std::uint64_t left = left_();
  if (done == 0 || done >= total || left >= at_first_ || at_first_ - left < kMinTaken) return;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  const double needed = static_cast<double>(at_first_ - left) * (1 - share) / share;
  if (needed <= 1.25 * static_cast<double>(left)) return;
  throw OutputError(format(
      "the clip's temporary capture will not fit: {} of {} samples took {}, the rest needs some {}, and "
      "{} are left in {}; make room there, or name another folder in TMPDIR",
      done, total, bytes_text(at_first_ - left), bytes_text(static_cast<std::uint64_t>(needed)),
      bytes_text(left), folder_.string()));
}

}  // namespace nutik::studio
