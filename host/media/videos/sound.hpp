// The sound of a clip, in a film of it.
//
//   in:      a clip with a stream of sound, when its part begins and how fast the film runs through it (FilmSound)
//   out:     a stream of the film's: packets of a codec with losses as they are where the container holds them and the
//            film begins with the clip and runs as fast as the file; else decoded, played slower or faster as a tape
//            is, and encoded anew
//   always:  a sound has the time of its picture, and ends with the film but for what is less than a frame
#pragma once

#include <memory>

#include "media/videos/libav.hpp"

namespace nutik::videos {

// The stream of sound that is played with the pictures, or a number below 0.
[[nodiscard]] int best_sound(const AVFormatContext& file);

class SoundWriter {
 public:
  virtual ~SoundWriter() = default;
  // Writes what is heard before that time of the film, of which it has not yet been written.
  virtual void write_to(double film_s) = 0;

  std::string note;       // what a person should know, if anything
  bool is_heard = false;  // anything of it, so far
};

// Adds a stream to a container whose header has not been written yet. Throws OutputError where it holds no sound that
// can be made here.
[[nodiscard]] std::unique_ptr<SoundWriter> open_sound(const FilmSound& sound, AVFormatContext& film,
                                                      const std::string& name);

}  // namespace nutik::videos
