#include "studio/window/project_file.hpp"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>
#include <QUuid>
#include <QtEndian>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/shell_text.hpp"
#include "studio/regions/covering.hpp"
#include "studio/regions/region_edits.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/output_file.hpp"

namespace nutik::studio {
namespace {

using NamedOptions = std::vector<std::pair<std::string, std::string>>;

// All but the files, by name.
NamedOptions options_of(const Document& document, const Stated& written, CommandId command = CommandId::expose) {
  const DocumentState& state = document.state();
  const bool is_plain = state.mode == ExposureMode::boxcar;
  const Stated& stated = document.facts()->stated;
  NamedOptions options(stated.begin(), stated.end());
  for (const auto& [name, value] : written)
    if (const Option& option = *option_of(command, name); option.is_of(CommandId::expose) && option.makes_picture())
      options.emplace_back(name, value);
  if (state.brightness_ev != 0) options.emplace_back("ev", format("{}", state.brightness_ev));
  if (is_plain) options.emplace_back("exposure", StatedTime::of_nanoseconds(state.boxcar.length_ns).text());
  if (const Feather feather = feather_of(state); !is_plain && state.mask && feather != Feather())
    options.emplace_back("feather", feather_text(feather));
  if (state.normalization != Normalization()) options.emplace_back("normalize", state.normalization.text());
  if (is_plain) options.emplace_back("start", StatedTime::of_nanoseconds(state.boxcar.start_ns).text());
  std::ranges::sort(options);
  return options;
}

std::string file_name(const QString& path) {
  return std::filesystem::path(path.toStdString()).filename().string();
}

constexpr const char* kVersionKey = "nutik-studio";
constexpr int kVersion = 1;
// Functions and mask of a project whose files do not hold them.
constexpr const char* kUnwrittenKey = "unwritten";
constexpr const char* kIdKey = "id";

// The key of an option in a project.
QString key_of(std::string_view name) {
  return QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size())).replace('-', '_');
}

void write_text(const QString& path, std::string_view text) {
  OutputFile file(path.toStdString());
  file.write(text);
  file.commit();
}

[[noreturn]] void refuse(const QString& path, const std::string& what) {
  throw InputError(format("{}: {}", path.toStdString(), what));
}

// A value has the type of what stands for it where it is absent.
QJsonValue value_in(const QJsonObject& object, const char* name, const QJsonValue& otherwise, const QString& path) {
  const QJsonValue value = object.contains(QLatin1String(name)) ? object[QLatin1String(name)] : otherwise;
  if (value.type() == otherwise.type()) return value;
  refuse(path, format("'{}' is {}", name, otherwise.isBool()     ? "neither true nor false"
                                          : otherwise.isDouble() ? "no number"
                                          : otherwise.isString() ? "no text"
                                                                 : "no list"));
}

// Whole nanoseconds as text: JSON's numbers are doubles for many readers.
std::int64_t time_in(const QJsonObject& object, const char* name, const QString& path) {
  bool is_number = false;
  const qlonglong time_ns = object[name].toString().toLongLong(&is_number);
  if (!is_number || time_ns < 0) refuse(path, format("'{}' is no time in nanoseconds", name));
  return time_ns;
}

QString packed_text(const std::vector<std::uint8_t>& pixels) {
  const auto* bytes = reinterpret_cast<const char*>(pixels.data());
  const auto size = static_cast<qsizetype>(pixels.size());
  return QString::fromLatin1(qCompress(QByteArray::fromRawData(bytes, size)).toBase64());
}

// Nothing where the text is damaged, or of another number of pixels.
QByteArray unpacked(const QString& text, std::size_t pixels) {
  const QByteArray packed = QByteArray::fromBase64(text.toLatin1());
  // What is packed begins with its size: nothing is unpacked that has another one.
  const bool is_as_large = packed.size() > 4 && qFromBigEndian<quint32>(packed.constData()) == pixels;
  const QByteArray bytes = is_as_large ? qUncompress(packed) : QByteArray();
  return bytes.size() == static_cast<qsizetype>(pixels) ? bytes : QByteArray();
}

Mask mask_in(const QJsonObject& object, const QString& path) {
  constexpr int kMaxSide = 32767;
  const auto side = [&](const char* name) {
    const int pixels = object[name].toInt();
    if (pixels < 1 || pixels > kMaxSide)
      refuse(path, format("its mask's {} is not from 1 to {}", name, kMaxSide));
    return static_cast<std::uint32_t>(pixels);
  };
  Mask mask = Mask::uniform(side("width"), side("height"), 0);
  const QByteArray bytes = unpacked(object["tags"].toString(), mask.tags.size());
  if (bytes.isEmpty()) refuse(path, "the mask in it is damaged");
  std::ranges::copy(bytes, mask.tags.begin());
  return mask;
}

// As large as the mask.
Region region_in(const QString& text, const Mask& mask, const QString& path) {
  Region region = Region::none(mask.width, mask.height);
  const QByteArray bytes = unpacked(text, region.inside.size());
  const auto is_flag = [](char byte) { return byte == 0 || byte == 1; };
  if (bytes.isEmpty() || !std::ranges::all_of(bytes, is_flag))
    refuse(path, format("what is covered of a region is damaged, or not {} x {} pixels large as the mask is",
                        mask.width, mask.height));
  std::ranges::copy(bytes, region.inside.begin());
  return region;
}

// In the order in which they cover each other.
void read_looks(const QJsonArray& regions, DocumentState& state, const QString& path) {
  for (const QJsonValue& value : regions) {
    const QJsonObject region = value.toObject();
    const int tag = region["tag"].toInt(-1);
    const QColor colour(region["colour"].toString());
    if (tag < 0 || tag > 255 || !colour.isValid())
      refuse(path, "a region has no tag from 0 to 255, or no colour");
    const auto value_of = static_cast<std::uint8_t>(tag);
    const RegionLook look{value_in(region, "name", "", path).toString(), colour,
                          value_in(region, "visible", true, path).toBool()};
    const bool is_new = state.looks.try_emplace(value_of, look).second;
    if (!is_new) refuse(path, format("it has two regions with the tag {}", tag));
    if (tag != 0) state.order.push_back(value_of);
    if (tag != 0 && state.mask && region.contains("covered"))
      state.covered.emplace(value_of,
                            Shared(region_in(region["covered"].toString(), (*state.mask)->mask, path)));
  }
  tidy_covered(state);
}

QJsonObject object_of(const QString& path, const Document& document, const CommandFiles& files) {
  const DocumentState& state = document.state();
  const QDir folder = QFileInfo(path).absoluteDir();
  const auto named = [&](const QString& file) {
    return folder.relativeFilePath(QFileInfo(file).absoluteFilePath());
  };
  QJsonArray regions;
  std::vector<std::uint8_t> tags = state.order;
  if (state.looks.contains(kBackground)) tags.push_back(kBackground);
  for (const std::uint8_t tag : tags) {
    const RegionLook& look = state.looks.at(tag);
    QJsonObject region{
        {"tag", tag}, {"name", look.name}, {"colour", look.colour.name()}, {"visible", look.is_visible}};
    if (const auto found = state.covered.find(tag); found != state.covered.end())
      region["covered"] = packed_text(found->second->inside);
    regions += region;
  }
  QJsonObject object{{kVersionKey, kVersion},
                     {"capture", named(document.facts()->path)},
                     {"duration_ns", QString::number(document.duration_ns())},
                     {"functions", named(files.functions)},
                     {"exposes", state.mode == ExposureMode::boxcar ? "interval" : "regions"},
                     {"start_ns", QString::number(state.boxcar.start_ns)},
                     {"length_ns", QString::number(state.boxcar.length_ns)},
                     {"normalize", QString::fromStdString(state.normalization.text())},
                     {"feather", QString::fromStdString(feather_text(state.feather))},
                     {"ev", state.brightness_ev},
                     {"regions", regions}};
  if (state.mask) object["mask"] = named(files.mask);
  if (document.mark_in()) object["in_ns"] = QString::number(*document.mark_in());
  if (document.mark_out()) object["out_ns"] = QString::number(*document.mark_out());
  for (const auto& [name, value] : document.facts()->stated)
    object[key_of(name)] = value.empty() ? QJsonValue(true) : QJsonValue(QString::fromStdString(value));
  return object;
}

// What the files are to hold.
QJsonObject unwritten_object_of(const DocumentState& state) {
  QJsonObject unwritten{{"functions", QString::fromStdString(functions_text(state.functions))}};
  if (state.mask) {
    const Mask& mask = (*state.mask)->mask;
    unwritten["mask"] = QJsonObject{{"width", static_cast<int>(mask.width)},
                                    {"height", static_cast<int>(mask.height)},
                                    {"tags", packed_text(mask.tags)}};
  }
  return unwritten;
}

QJsonObject object_in(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {};
  return QJsonDocument::fromJson(file.readAll()).object();
}

// A random number that was made for the project; empty: it has none.
QString id_in(const QString& path) { return object_in(path)[kIdKey].toString(); }

// What the project's files carry. A copy under another name has another mark: it does not replace them unasked.
QString mark_of(const QString& path, const QString& id) {
  if (id.isEmpty()) return {};
  const std::string both = format("{} {}", id.toStdString(), QFileInfo(path).fileName().toStdString());
  return QString::fromStdString(
      format("of the nutik-studio project {:016x}", checksum(std::string_view(both))));
}

void write_object(const QString& path, const QJsonObject& object) {
  write_text(path, QJsonDocument(object).toJson().toStdString());
}

}  // namespace

QString command_line(const Document& document, const CommandFiles& files, const QString& picture,
                     const Stated& written) {
  const DocumentState& state = document.state();
  std::string line = "nutik-cl expose";
  const auto add = [&](const std::string& option, const QString& file) {
    line += " " + option + " " + shell_word(file.toStdString());
  };
  if (state.mode == ExposureMode::functions) {
    add("-k", files.functions);
    if (state.mask) add("-m", files.mask);
  }
  NamedOptions options = options_of(document, written);
  for (const auto& [name, value] : written)
    if (!option_of(CommandId::expose, name)->makes_picture()) options.emplace_back(name, value);
  if (const auto& precision = document.facts()->precision) options.emplace_back("precision", to_text(*precision));
  for (const auto& [name, value] : options) line += " --" + name + (value.empty() ? "" : " " + shell_word(value));
  line += " " + shell_word(document.facts()->path.toStdString()) + " " + shell_word(picture.toStdString());
  return QString::fromStdString(line);
}

RecipeSources recipe_sources(const Document& document, const CommandFiles& files, const Stated& written,
                             CommandId command) {
  const DocumentState& state = document.state();
  RecipeSources sources{{}, document.facts()->path.toStdString(), {}};
  Recipe& recipe = sources.made;
  recipe.version = NUTIK_VERSION;
  recipe.options = options_of(document, written, command);
  recipe.renderer = "opencl";
  if (state.mode == ExposureMode::functions) {
    recipe.functions = Recipe::Text{file_name(files.functions),
                                    std::string(InputBytes(files.functions.toStdString()).text())};
    if (state.mask)
      recipe.mask = Recipe::Input{file_name(files.mask), mask_checksum(files.mask.toStdString())};
  }
  return sources;
}

bool is_pattern(const QString& path) {
  const QFileInfo file(path);
  return !file.exists() && file.dir().exists() && file.fileName().contains(QRegularExpression("[%*?[]"));
}

CommandFiles free_files_beside(const QString& project, const QString& capture) {
  const QFileInfo info(project);
  const QString stem = info.dir().filePath(info.completeBaseName());
  for (int tried = 1;; ++tried) {
    const QString name = tried == 1 ? stem : QString("%1-%2").arg(stem, QString::number(tried));
    CommandFiles files{name + ".pgm", name + ".fn"};
    const bool is_captures = files.mask == capture || files.functions == capture;
    if (!is_captures && foreign_files(project, files).isEmpty()) return files;
  }
}

QStringList foreign_files(const QString& project, const CommandFiles& files) {
  const QByteArray mark = mark_of(project, id_in(project)).toUtf8();
  QStringList foreign;
  for (const QString& path : {files.functions, files.mask}) {
    if (path.isEmpty() || (!QFileInfo::exists(path) && !QFileInfo(path).isSymLink())) continue;
    constexpr qint64 kMostBefore = 4096;  // a mark is at the beginning
    QFile file(path);
    const bool is_ours =
        !mark.isEmpty() && file.open(QIODevice::ReadOnly) && file.read(kMostBefore).contains(mark);
    if (!is_ours) foreign += path;
  }
  return foreign;
}

void save_functions(const QString& path, const FunctionSet& functions, const QString& mark) {
  const std::string comment = mark.isEmpty() ? "" : format("# {}\n", mark.toStdString());
  write_text(path, comment + functions_text(functions));
}

void save_mask(const QString& path, const Mask& mask, const QString& mark) {
  write_picture(path.toStdString(), mask.to_picture(), mark.toStdString());
}

FunctionSet load_functions(const QString& path) { return *read_function_input(path.toStdString()).functions; }

Shared<MaskWithRegions> load_mask(const QString& path) {
  return Shared(MaskWithRegions(read_mask_input(path.toStdString())));
}

void save_project(const QString& path, const Document& document, const CommandFiles& files) {
  const QString found = id_in(path);
  const QString id = found.isEmpty() ? QUuid::createUuid().toString(QUuid::WithoutBraces) : found;
  const QString mark = mark_of(path, id);
  QJsonObject object = object_of(path, document, files);
  object[kIdKey] = id;
  // All is in one file, and so saved at once. Those beside it follow, and until they have followed they are not asked.
  QJsonObject whole = object;
  whole[kUnwrittenKey] = unwritten_object_of(document.state());
  write_object(path, whole);
  save_functions(files.functions, document.state().functions, mark);
  if (document.state().mask) save_mask(files.mask, (*document.state().mask)->mask, mark);
  write_object(path, object);
}

void keep_project(const QString& path, const Document& document) {
  QJsonObject whole = object_of(path, document, {path, path});  // no files
  whole[kUnwrittenKey] = unwritten_object_of(document.state());
  write_object(path, whole);
}

QString capture_name_in(const QString& path) {
  return QFileInfo(object_in(path)["capture"].toString()).fileName();
}

Project load_project(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) refuse(path, file.errorString().toStdString());
  QJsonParseError mistake;
  const QJsonDocument json = QJsonDocument::fromJson(file.readAll(), &mistake);
  if (!json.isObject())
    refuse(path,
           mistake.error == QJsonParseError::NoError
               ? "it is no project: it holds no JSON object"
               : format("it is no project: {} at byte {}", mistake.errorString().toStdString(), mistake.offset));
  const QJsonObject object = json.object();
  if (!object.contains(kVersionKey)) refuse(path, format("it is no project: it has no '{}'", kVersionKey));
  const double version = value_in(object, kVersionKey, 0.0, path).toDouble();
  if (version != kVersion)
    refuse(path, format("it says '{}': {}, and this program reads {}", kVersionKey, version, kVersion));
  const QDir folder = QFileInfo(path).absoluteDir();
  const auto resolved = [&](const char* name) {
    const QString text = object[name].toString();
    if (text.isEmpty()) refuse(path, format("'{}' names no file", name));
    return QDir::cleanPath(folder.absoluteFilePath(text));
  };
  Project project;
  project.capture = resolved("capture");
  for (const char* name : {"align", "between", "deflicker", "fps", "ignore-errors"}) {
    const Option& option = *find_option(name);
    const QString key = key_of(object.contains(key_of(name)) ? name : option.old_name);
    if (!object.contains(key)) continue;
    if (option.is_flag() && !value_in(object, qPrintable(key), false, path).toBool()) continue;
    const bool is_number = object[key].isDouble();
    if (!option.is_flag() && !is_number) value_in(object, qPrintable(key), "", path);
    const std::string text = object[key].toString().toStdString();
    project.stated.emplace(name, is_number ? format("{}", object[key].toDouble()) : text);
  }
  const CommandFiles free_files = free_files_beside(path, project.capture);
  project.files = free_files;
  project.files.functions = resolved("functions");
  DocumentState& state = project.state;
  if (object.contains("mask")) project.files.mask = resolved("mask");
  if (object.contains(kUnwrittenKey)) {
    project.is_unwritten = true;
    // Those that nobody has read are not written wherever a project says.
    if (!QFileInfo::exists(project.files.functions)) project.files.functions = free_files.functions;
    if (!QFileInfo::exists(project.files.mask)) project.files.mask = free_files.mask;
    const QJsonObject unwritten = object[kUnwrittenKey].toObject();
    state.functions =
        *read_functions(unwritten["functions"].toString().toStdString(), path.toStdString()).functions;
    if (unwritten.contains("mask"))
      state.mask = Shared(MaskWithRegions(mask_in(unwritten["mask"].toObject(), path)));
  } else {
    state.functions = load_functions(project.files.functions);
    if (object.contains("mask")) state.mask = load_mask(project.files.mask);
  }
  const QString exposes = value_in(object, "exposes", "regions", path).toString();
  if (exposes != "interval" && exposes != "regions") refuse(path, "'exposes' is neither 'interval' nor 'regions'");
  state.mode = exposes == "interval" ? ExposureMode::boxcar : ExposureMode::functions;
  state.boxcar = {time_in(object, "start_ns", path), time_in(object, "length_ns", path)};
  if (object.contains("duration_ns")) project.duration_ns = time_in(object, "duration_ns", path);
  if (object.contains("in_ns")) project.marks.in_ns = time_in(object, "in_ns", path);
  if (object.contains("out_ns")) project.marks.out_ns = time_in(object, "out_ns", path);
  try {
    state.normalization = Normalization::parse(value_in(object, "normalize", "", path).toString().toStdString());
    state.feather = Feather::parse(value_in(object, "feather", "", path).toString().toStdString());
  } catch (const UsageError& error) {
    refuse(path, error.what());
  }
  state.brightness_ev = value_in(object, "ev", 0.0, path).toDouble();
  if (std::abs(state.brightness_ev) > kMostBrightnessEv)
    refuse(path, format("'ev' is not from -{0} to {0}", kMostBrightnessEv));
  read_looks(value_in(object, "regions", QJsonArray(), path).toArray(), state, path);
  return project;
}

}  // namespace nutik::studio
