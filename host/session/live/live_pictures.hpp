// Pictures for a caller that changes its mind, as a window does while a control point is dragged: the latest request
// wins.
//
//   in:      requests: a preview, which is what can be seen, and the full picture that follows it
//   out:     previews and full pictures, in the order in which they were asked for
//   always:  one preview is in flight and one waits: a newer request takes the place of the one that waits and stops
//            none in flight, so that pictures come as long as requests do. A full picture is exposed strip by strip
//            while no preview waits, one with a map of bounds at once, and is given up between two strips when there is
//            a newer request. Nothing is delivered that is older than what was delivered before
//   threads: any number may ask. Answers come from a thread of this object's own, one at a time
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "session/session.hpp"

namespace nutik {

struct LivePart {
  // Read whole; of a reduced capture for a preview that is zoomed out. Outlives the LivePictures.
  Session* session;
  ExposureRequest exposure;
  OutputFormat output;
  Rectangle rectangle;  // of the session's picture
  std::optional<Precision> precision = {};  // of a full picture; none: what suits it
};

struct LiveRequest {
  LivePart preview;  // in single precision, where the device computes that rightly
  std::optional<LivePart> full = {};
};

struct LiveAnswer {
  std::uint64_t request = 0;  // as ask() numbered it
  bool is_preview = false;
  Rectangle rectangle;  // that was asked for
  // Its picture: a full one is that of Session::render(), times and launches aside. Or what that threw.
  std::optional<ExposedPicture> exposed;
  std::exception_ptr error;
};

class LivePictures {
 public:
  // Must not throw, and keeps the next picture waiting. May ask.
  using Deliver = std::function<void(LiveAnswer)>;

  explicit LivePictures(Deliver deliver);
  // Stops what is in flight. Nothing is delivered afterwards.
  ~LivePictures();
  LivePictures(const LivePictures&) = delete;
  LivePictures& operator=(const LivePictures&) = delete;

  // Returns at once: the request's number, from 1 on.
  std::uint64_t ask(LiveRequest request);
  // Returns when the last request has been answered. Not for deliver().
  void wait();

 private:
  struct Asked {
    std::uint64_t number;
    LiveRequest request;
  };
  // A full picture as far as it is.
  struct Strips {
    std::uint64_t number;
    LivePart part;
    std::uint32_t rows_at_once;
    std::optional<ExposedPicture> exposed = {};
    std::uint32_t next_row = 0;
  };

  void work(const std::stop_token& stop);
  void preview(Asked asked, const std::stop_token& stop);
  void expose_strip(const std::stop_token& stop);
  void answer(LiveAnswer answer);

  Deliver deliver_;
  bool previews_in_single_ = true;
  std::optional<Strips> strips_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable_any changed_;
  std::optional<Asked> waiting_;
  std::uint64_t last_number_ = 0;
  bool is_busy_ = false;

  std::jthread worker_;  // last: it uses everything else
};

}  // namespace nutik
