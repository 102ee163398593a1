// Parts of jobs: a capture is opened, or a clip, which is encoded into a temporary capture; then comes what is shown
// beside its picture: when it changes, small pictures of it, the light of one pixel.
#pragma once

#include <QImage>
#include <QStringList>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

// Whether a temporary capture will fit, looked at while it is written: what its first samples took says what the rest
// will take.
//
//   in:   progress in samples; the bytes that are left where it lies
//   out:  OutputError once the rest is sure not to fit, while there still is room
//   kept: a quarter more than is left is let pass, since what follows may pack better

class RoomWatch {
 public:
  using Left = std::function<std::uint64_t()>;

  explicit RoomWatch(const std::filesystem::path& folder);
  RoomWatch(std::filesystem::path folder, Left left);

  void look(std::uint64_t done, std::uint64_t total) const;

 private:
  std::filesystem::path folder_;
  Left left_;
  std::uint64_t at_first_;
};

struct Opened {
  std::shared_ptr<Session> session;
  CaptureFacts facts;
  QStringList notes;  // what a person should know of the clip, whole sentences
};

// `first_look`, which may be empty, is told a clip's first picture, on the job's thread, before the clip is read whole.
// Throws what Session does.
[[nodiscard]] Opened open_capture(const QString& path, const Stated& stated, std::shared_ptr<Devices> devices,
                                  const Job& job, const std::function<void(QImage)>& first_look = {});

// What a capture has between the marks, as a capture of its own that begins at a time of that one; the capture itself
// where there are none. Throws what session_of_part() does.
struct Stretch {
  std::shared_ptr<Session> session;
  std::int64_t start_ns = 0;
};
[[nodiscard]] Stretch stretch_between(const Marks& marks, std::shared_ptr<Session> session, const Job& job);

// Small pictures at evenly spaced times.
[[nodiscard]] CaptureOverview thumbnails_of(Session& session, const Job& job);
// By sample.
[[nodiscard]] std::vector<double> changed_shares_of(Session& session, const Job& job);
[[nodiscard]] Waveform waveform_of(Session& session, QPoint pixel);

}  // namespace nutik::studio
