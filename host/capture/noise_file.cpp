#include "capture/noise_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/picture.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"

namespace nutik {
namespace {

constexpr std::string_view kFirstLine = "nutik noise 0";
constexpr std::size_t kMaxMistakes = 20;

struct Word {
  std::size_t at;
  std::string_view text;
};

class Parser {
 public:
  Parser(std::string_view bytes, const std::string& name) : text_(bytes), name_(name) {}

  CameraNoise parse() {
    for (std::size_t at = 0; at < text_.size() && mistakes_.size() < kMaxMistakes;
         at = text_.line_end(at) + 1) {
      parse_line(at);
    }
    if (mistakes_.empty()) check_whole();
    if (!mistakes_.empty()) throw InputError(joined(mistakes_, "\n"));
    return std::move(noise_);
  }

 private:
  void report(std::size_t at, const std::string& what) {
    const TextPlace place = text_.place_of(std::min(at, text_.size() - 1));
    mistakes_.push_back(format("{}:{}:{}: {}", name_, place.line, place.column, what));
  }

  [[nodiscard]] std::vector<Word> words_of(std::size_t line) const {
    const auto is_blank = [&](std::size_t at) { return text_[at] == ' ' || text_[at] == '\t'; };
    std::vector<Word> words;
    const std::size_t end = std::min(text_.line_end(line), text_.view().find('#', line));
    for (std::size_t at = line; at < end;) {
      while (at < end && is_blank(at)) ++at;
      const std::size_t begin = at;
      while (at < end && !is_blank(at)) ++at;
      if (at > begin) words.push_back({begin, text_.piece(begin, at)});
    }
    return words;
  }

  void parse_line(std::size_t line) {
    const std::vector<Word> words = words_of(line);
    if (words.empty()) return;
    const std::string_view key = words.front().text;
    if (!has_first_line_) {
      has_first_line_ = true;
      const std::string said = joined(words, " ", &Word::text);
      if (said != kFirstLine) {
        report(words.front().at, format("a noise file starts with the line '{}'; this one with {}",
                                        kFirstLine, quoted(said)));
      }
    } else if (key == "white") {
      parse_white(words);
    } else if (key == "transfer") {
      parse_transfer(words);
    } else if (key == "channel") {
      parse_channel(words);
    } else if (key == "read" || key == "shot" || key == "curve" || key == "point") {
      if (noise_.channels.empty()) {
        report(words.front().at, format("'{}' stands before the first channel", key));
      } else {
        parse_of_channel(key, words);
      }
    } else {
      report(words.front().at,
             format("{} is no key; a line starts with white, transfer, channel, read, shot, curve or point",
                    quoted(key)));
    }
  }

  // Whether a line has so many values behind its key.
  bool has_values(const std::vector<Word>& words, std::size_t count, std::string_view as_in) {
    if (words.size() == count + 1) return true;
    const Word& where = words.size() > count + 1 ? words[count + 1] : words.back();
    report(where.at, format("'{}' takes {} value{}, not {}: {}", words.front().text, count,
                            count == 1 ? "" : "s", words.size() - 1, as_in));
    return false;
  }

  // A number of [low, high].
  std::optional<double> number(const Word& word, std::string_view what, double low, double high) {
    const auto value = parsed<double>(word.text);
    if (value && *value >= low && *value <= high) return value;
    report(word.at, format("{} {} is no number of {} … {}", what, quoted(word.text), low, high));
    return std::nullopt;
  }

  void parse_white(const std::vector<Word>& words) {
    if (has_white_) report(words.front().at, "the white code is stated twice");
    has_white_ = true;
    if (!has_values(words, 1, "white 255")) return;
    const auto white = number(words[1], "white code", 1, 65'535);
    if (!white) return;
    if (*white != std::floor(*white)) {
      report(words[1].at, "the white code is a whole number");
    } else {
      noise_.white_code = static_cast<std::uint32_t>(*white);
    }
  }

  void parse_transfer(const std::vector<Word>& words) {
    if (has_transfer_) report(words.front().at, "the transfer function is stated twice");
    has_transfer_ = true;
    if (!has_values(words, 1, "transfer srgb")) return;
    try {
      noise_.transfer = Transfer::parse(words[1].text);
    } catch (const UsageError&) {
      report(words[1].at, format("transfer {} is not known; choose srgb, bt709, linear or gamma:G",
                                 quoted(words[1].text)));
    }
  }

  void parse_channel(const std::vector<Word>& words) {
    if (!has_white_ || !has_transfer_) {
      report(words.front().at, "white and transfer must be stated before the first channel");
    }
    if (!noise_.channels.empty()) check_channel();
    const std::size_t channel = noise_.channels.size();
    noise_.channels.emplace_back();
    seen_ = {};
    channel_at_ = words.front().at;
    if (!has_values(words, 1, "channel red")) return;
    if (channel == 0) is_grey_ = words[1].text == channel_name(1, 0);
    const std::size_t most = is_grey_ ? 1 : 3;
    if (channel >= most) {
      report(words[1].at, "there is a channel too many: a file has grey alone, or red, green and blue");
    } else if (words[1].text != channel_name(most, channel)) {
      report(words[1].at,
             format("channel {} where {} was expected; a file has grey alone, or red, green and "
                    "blue in this order",
                    quoted(words[1].text), channel == 0 ? "grey or red" : channel_name(3, channel)));
    }
  }

  void parse_of_channel(std::string_view key, const std::vector<Word>& words) {
    ChannelNoise& channel = noise_.channels.back();
    if (key == "point") {
      parse_point(channel, words);
      return;
    }
    bool& was_seen = key == "read" ? seen_.read : key == "shot" ? seen_.shot : seen_.curve;
    if (was_seen) report(words.front().at, format("'{}' is stated twice for this channel", key));
    was_seen = true;
    if (key == "curve") {
      if (!has_values(words, 1, "curve sensor")) return;
      if (words[1].text == to_text(NoiseCurve::sensor)) {
        channel.curve = NoiseCurve::sensor;
      } else if (words[1].text == to_text(NoiseCurve::points)) {
        channel.curve = NoiseCurve::points;
      } else {
        report(words[1].at, format("curve {} is not known; choose sensor or points", quoted(words[1].text)));
      }
      return;
    }
    if (!has_values(words, 1, format("{} 0.002", key))) return;
    const auto value = number(words[1], key, 0, 1);
    if (value) (key == "read" ? channel.read : channel.shot) = *value;
  }

  void parse_point(ChannelNoise& channel, const std::vector<Word>& words) {
    if (!has_values(words, 3, "point CODE SD PIXELS")) return;
    const auto code = number(words[1], "code", 0, noise_.white_code);
    const auto sd = number(words[2], "standard deviation", 1e-3, noise_.white_code);
    const auto pixels = number(words[3], "pixels", 0, 0x1p62);
    if (!code || !sd || !pixels) return;
    if (channel.points.size() == kMaxNoisePoints) {
      report(words.front().at, format("there are more than {} points in this channel", kMaxNoisePoints));
      return;
    }
    if (!channel.points.empty() && !(*code > channel.points.back().code)) {
      report(words[1].at, format("code {} is not above the one before, {}; codes must increase", *code,
                                 channel.points.back().code));
      return;
    }
    channel.points.push_back({*code, *sd, static_cast<std::uint64_t>(*pixels)});
  }

  void check_channel() {
    const ChannelNoise& channel = noise_.channels.back();
    if (!seen_.curve) {
      report(channel_at_, "this channel does not say which curve is used: 'curve sensor' or 'curve points'");
    } else if (channel.curve == NoiseCurve::sensor && !(seen_.read && seen_.shot)) {
      report(channel_at_, "this channel uses 'curve sensor' and must say read and shot");
    } else if (channel.curve == NoiseCurve::points && channel.points.empty()) {
      report(channel_at_, "this channel uses 'curve points' and has no point");
    }
  }

  void check_whole() {
    if (!has_first_line_) {
      report(0, format("an empty noise file; it starts with the line '{}'", kFirstLine));
    } else if (noise_.channels.empty()) {
      report(text_.size(), "no channel; write 'channel grey', or red, green and blue");
    } else {
      check_channel();
      if (!is_grey_ && noise_.channels.size() != 3) {
        report(text_.size(),
               format("{} of 3 channels; red, green and blue are needed", noise_.channels.size()));
      }
    }
  }

  struct Seen {
    bool read = false, shot = false, curve = false;
  };

  SourceText text_;
  const std::string& name_;
  CameraNoise noise_;
  std::vector<std::string> mistakes_;
  bool has_first_line_ = false, has_white_ = false, has_transfer_ = false, is_grey_ = false;
  Seen seen_;  // of the last channel
  std::size_t channel_at_ = 0;
};

}  // namespace

CameraNoise parse_noise(std::string_view bytes, const std::string& name) {
  return Parser(bytes, name).parse();
}

std::vector<std::string> noise_lines(const CameraNoise& noise) {
  std::vector<std::string> lines{std::string(kFirstLine), format("white {}", noise.white_code),
                                 format("transfer {}", noise.transfer.text())};
  for (std::size_t c = 0; c < noise.channels.size(); ++c) {
    const ChannelNoise& channel = noise.channels[c];
    lines.push_back(format("channel {}", channel_name(noise.channels.size(), c)));
    lines.push_back(format("read {}", channel.read));
    lines.push_back(format("shot {}", channel.shot));
    lines.push_back(format("curve {}", to_text(channel.curve)));
    for (const NoisePoint& point : channel.points) {
      lines.push_back(format("point {} {} {}", point.code, point.sd, point.pixels));
    }
  }
  return lines;
}

std::string noise_text(const CameraNoise& noise, std::span<const std::string> comments) {
  const auto comment_on = [](std::string_view line) -> std::string_view {
    const std::string_view key = line.substr(0, line.find(' '));
    if (key == "white") return "the code that stands for white; all codes below count up to it";
    if (key == "transfer") return "how codes stand for light";
    if (key == "read") return "standard deviation in light where there is none";
    if (key == "shot") return "variance in light for each unit of light";
    if (key == "curve") return "what is used: sensor (read and shot) or points (lines between those below)";
    return {};
  };
  std::string text;
  for (const std::string& line : noise_lines(noise)) {
    if (line.starts_with("channel")) text += '\n';
    const std::string_view comment = comment_on(line);
    text += comment.empty() ? line + '\n' : format("{:<28}# {}\n", line, comment);
    if (line == kFirstLine) {
      for (const std::string& each : comments) text += format("# {}\n", each);
    }
    if (line.starts_with("curve")) text += "#     code, standard deviation in codes, pixels measured\n";
  }
  return text;
}

}  // namespace nutik
