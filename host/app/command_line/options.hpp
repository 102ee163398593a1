// Everything that can be said on the command line, as it was said.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nutik::app {

struct Options {
  std::vector<std::string> operands;

  // The source clip.
  std::optional<std::string> fps;
  std::optional<std::string> shutter_angle;
  std::optional<std::string> white;
  std::optional<std::string> transfer;
  std::optional<std::string> raw;
  std::optional<std::string> noise;
  std::optional<std::string> sigmas;

  // The exposure.
  std::optional<std::string> mask;
  std::optional<std::string> functions;
  std::optional<std::string> start;
  std::optional<std::string> exposure;
  std::optional<std::string> unmapped;
  std::optional<std::string> live;

  // How it is computed.
  std::optional<std::string> renderer;
  std::optional<std::string> device;
  std::optional<std::string> precision;

  // The file.
  std::optional<std::string> output;
  std::optional<std::string> depth;
  std::optional<std::string> tolerance;
  std::optional<std::string> codec;
  std::optional<std::string> tiles;
  std::optional<std::string> block_samples;
  std::optional<std::string> activity;

  bool quiet = false;
  bool verbose = false;
};

}  // namespace nutik::app
