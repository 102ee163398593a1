// The subject: what differs from the plate and goes furthest, and where it goes.
//
//   in:      a capture and its plate, as codes of the capture
//   out:     where the subject is at the samples at which it was found
//   units:   pixels from the top left corner. Pictures are looked at in cells of several pixels, so that large ones
//            take no longer
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "mask/region.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct SubjectPlace {
  std::uint64_t sample = 0;
  Point centre;                    // of gravity
  Rectangle box;                   // that holds it, with a border
  bool is_cut_off = false;         // by the border of the picture or of the region that is looked at
  double share = 0;                // of all that differs from the plate then
  double fill = 0;                 // of the least box that holds it
  double contrast = 0;             // how far it differs from the plate on average, as a share of white
  std::vector<std::size_t> cells;  // that it covers, increasing
  std::size_t solid = 0;           // how many of them are no shadow
};

// How many cells both cover.
[[nodiscard]] std::size_t common_cells(const SubjectPlace& place, const SubjectPlace& other);

inline constexpr std::size_t kMinCells = 6;  // that hang together: fewer are noise

struct SubjectTrack {
  std::uint32_t cell_side = 1;           // in pixels
  std::uint32_t cell_columns = 0;        // in a row
  std::vector<SubjectPlace> places;      // in time order; none of samples at which it was not found
  std::vector<std::uint64_t> looked_at;  // samples, increasing: all, or so many evenly over the capture
  // The longest stretch of them at which nothing at all differs from the plate, in all of the picture: what is taken
  // away with it is taken from there, too.
  SampleRange empty;
  // At each of looked_at: the cells that differ, of all things.
  std::shared_ptr<std::vector<std::vector<bool>>> differing;
  std::vector<SampleRange> rests;   // where it stays in its place for a good part of the time
  std::vector<SubjectTrack> others;  // what goes its way half as far or more at the same time
  std::vector<SubjectTrack> instead;  // what goes half as far or more, the furthest first, if this one makes no study
  std::vector<SubjectTrack> lesser;   // what else goes its way, the furthest first
  double extent = 0;  // in pixels, from where its centre is furthest to one side to the other
  double fill = 1;                  // of its places' boxes; a median
  double share = 1;                 // of all that differs from the plate when it is there; a median
  bool flickers = false;            // its places lie here and there, as if it were no single thing
  std::vector<std::size_t> bare;    // ground that it laid bare for good: cells that whoever knows sets, increasing
  double moving_share = 0;          // of the picture, that differs from the plate on average

  // In pixels: the root of the area that it usually covers. 0 where there is none.
  [[nodiscard]] double size() const;
  // In pixels: the longer side of the least box that usually holds it; less at the picture's border.
  [[nodiscard]] double length() const;
  // It fills less than half of its boxes and is less than half of what differs: most that is seen there is the plate,
  // and most that moves is elsewhere. Edges of something that shakes or grows are like that.
  [[nodiscard]] bool is_scraps() const { return fill < 0.5 && share < 0.5; }
  // The average share of the time from the first place to the last, without rests, for which a cell is covered that is
  // covered at all.
  [[nodiscard]] double covered_share() const;
  // The share of all the time for which the cell is covered that is covered longest. A thing that is somewhere for half
  // of the time is in the plate there, and its cells are found while it is elsewhere.
  [[nodiscard]] double most_covered_share() const;
  // Cells that differ for nearly all of its way, each what hangs together: where the plate shows it, the ground that it
  // has left.
  [[nodiscard]] std::vector<std::vector<std::size_t>> changed_for_good() const;
  // A place with so many pixels around it, and times of a few looks at which nothing differs there: the longest first,
  // then the nearest. None where ground was laid bare: the thing lay on it all that time.
  struct BareGround {
    std::vector<std::size_t> cells;  // that do not differ at the place's own sample, increasing
    std::vector<SampleRange> times;
  };
  [[nodiscard]] BareGround bare_ground(const SubjectPlace& place, std::uint32_t pixels) const;
};

// Still things that lie so many pixels from where the plate has them, or more, are taken for what moves: half of a cell
// along their edges differs.
[[nodiscard]] double min_misplaced_pixels(const Shape& shape);

// Finds a subject in each region. A pixel differs from the plate if one of its channels does by more than `by_codes`.
// Connected cells of one sample are taken for the thing that was nearest to where they would be by its way so far; the
// subject is the thing that goes furthest for its size. Throws InputError where the capture is damaged.
[[nodiscard]] std::vector<SubjectTrack> track_subjects(
    CaptureSource& capture, const Picture& plate, std::uint32_t by_codes, const std::vector<Rectangle>& regions,
    const ReportedProgress& progress = {});

}  // namespace nutik
