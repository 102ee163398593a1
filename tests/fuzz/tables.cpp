// Tables of stills, whose files all exist.
#include "fuzz/target.hpp"
#include "media/stills/stills_table.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  as_file({}, "a.png");
  as_file({}, "b.png");
  const auto path = as_file(input, "stills.csv");
  const std::vector<ListedStill> stills = read_stills_table(path);
  const std::vector<StillTimes> exif(stills.size(), StillTimes{{}, 1'000'000});
  const ClipTiming timing = timing_of(path, stills, exif);
  ClipInfo info;
  info.timing = timing;
  static_cast<void>(timeline_of("stills.csv", info, {}, Timeline::kFullShutter, stills.size()));
}

}  // namespace

const Target kTarget{{1 << 22, 2000}, read};

}  // namespace nutik::fuzz
