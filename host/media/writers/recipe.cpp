#include "media/writers/recipe.hpp"

#include <nlohmann/json.hpp>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "media/stills/picture_text.hpp"

namespace nutik {
namespace {

using Json = nlohmann::ordered_json;

bool is_utf8(const std::string& bytes) {
  try {
    static_cast<void>(Json(bytes).dump());
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

// Each byte as the character of that number (ISO 8859-1), so that comments in any encoding come back as they were.
std::string characters_of(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text.push_back(c);
    } else {
      text.push_back(static_cast<char>(0xC0 | byte >> 6));
      text.push_back(static_cast<char>(0x80 | (byte & 0x3F)));
    }
  }
  return text;
}

std::string bytes_of(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const bool is_pair = lead >= 0xC0 && i + 1 < text.size();
    bytes.push_back(is_pair ? static_cast<char>((lead & 0x03) << 6 | (text[i + 1] & 0x3F)) : text[i]);
    i += is_pair;
  }
  return bytes;
}

// Under one of two keys, by whether it is UTF-8.
void add_bytes(Json& json, const char* if_text, const char* if_not, const std::string& bytes) {
  const bool is_text = is_utf8(bytes);
  json[is_text ? if_text : if_not] = is_text ? bytes : characters_of(bytes);
}
std::string taken_bytes(const Json& json, const char* if_text, const char* if_not) {
  return json.contains(if_text) ? json.at(if_text).get<std::string>() : bytes_of(json.at(if_not));
}
std::string taken_name(const Json& json) { return taken_bytes(json, "name", "name_bytes"); }

Json input_json(const Recipe::Input& input) {
  Json json;
  add_bytes(json, "name", "name_bytes", input.name);
  json["checksum"] = input.checksum;
  return json;
}

Json text_json(const Recipe::Text& text) {
  Json json;
  add_bytes(json, "name", "name_bytes", text.name);
  add_bytes(json, "text", "bytes", text.bytes);
  return json;
}

bool is_plain(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

[[noreturn]] void fail_name(const std::string& picture, const std::string& name) {
  throw InputError(format("{}: its recipe names {}, which no recipe of nutik-cl does: names have no folders",
                          picture, nutik::quoted(name)));
}

// In `frames/*.png` the folder is part of the name.
Recipe::Input input_of(const Json& json, const std::string& picture) {
  Recipe::Input input{taken_name(json), json.at("checksum")};
  const std::string_view name = input.name;
  const auto slash = name.find('/');
  const bool has_folder = slash != std::string_view::npos;
  if ((has_folder && !is_plain(name.substr(0, slash))) ||
      !is_plain(name.substr(has_folder ? slash + 1 : 0))) {
    fail_name(picture, input.name);
  }
  return input;
}

RecipeOf recipe_of(const Json& json, const std::string& picture) {
  const std::string name = json.value("command", std::string(to_text(RecipeOf::expose)));
  for (const RecipeOf of : {RecipeOf::expose, RecipeOf::contact, RecipeOf::sweep}) {
    if (name == to_text(of)) return of;
  }
  throw InputError(format("{}: its recipe is one of {}, which leaves none", picture, nutik::quoted(name)));
}

Recipe::Text text_of(const Json& json, const std::string& picture) {
  Recipe::Text text{taken_name(json), taken_bytes(json, "text", "bytes")};
  if (!is_plain(text.name)) fail_name(picture, text.name);
  return text;
}

}  // namespace

std::string_view to_text(RecipeOf of) {
  switch (of) {
    case RecipeOf::expose: return "expose";
    case RecipeOf::contact: return "contact";
    case RecipeOf::sweep: return "sweep";
  }
  return {};
}

std::string Recipe::text() const {
  Json json;
  json["nutik-cl"] = version;
  if (!file.empty()) json["file"] = file;
  if (of != RecipeOf::expose) json["command"] = to_text(of);
  json["capture"] = input_json(capture);
  if (functions) json["functions"] = text_json(*functions);
  if (noise) json["noise"] = text_json(*noise);
  if (mask) json["mask"] = input_json(*mask);
  if (delay_map) json["delay_map"] = input_json(*delay_map);
  if (mask_to) json["mask_to"] = input_json(*mask_to);
  json["options"] = Json::object();
  for (const auto& [name, value] : options) json["options"][name] = value;
  json["renderer"] = renderer;
  json["precision"] = precision;
  if (!error_bound.empty()) json["error_bound"] = error_bound;
  if (bounds_map) json["bounds_map"] = input_json(*bounds_map);
  constexpr int kOneLine = -1;
  // Options may be in any encoding.
  return json.dump(kOneLine, ' ', true, Json::error_handler_t::replace);
}

Recipe Recipe::parse(std::string_view text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    Recipe recipe;
    recipe.version = json.at("nutik-cl");
    recipe.file = json.value("file", "");
    recipe.of = recipe_of(json, name);
    recipe.capture = input_of(json.at("capture"), name);
    if (json.contains("functions")) recipe.functions = text_of(json.at("functions"), name);
    if (json.contains("noise")) recipe.noise = text_of(json.at("noise"), name);
    if (json.contains("mask")) recipe.mask = input_of(json.at("mask"), name);
    if (json.contains("delay_map")) recipe.delay_map = input_of(json.at("delay_map"), name);
    if (json.contains("mask_to")) recipe.mask_to = input_of(json.at("mask_to"), name);
    for (const auto& [option, value] : json.at("options").items()) recipe.options.emplace_back(option, value);
    recipe.renderer = json.at("renderer");
    recipe.precision = json.at("precision");
    recipe.error_bound = json.value("error_bound", std::string());
    if (json.contains("bounds_map")) {
      const Json& map = json.at("bounds_map");
      recipe.bounds_map = map.is_string() ? Recipe::Input{map, {}} : input_of(map, name);
      if (!is_plain(recipe.bounds_map->name)) fail_name(name, recipe.bounds_map->name);
    }
    return recipe;
  } catch (const Json::exception& error) {
    throw InputError(format("{}: its recipe is damaged: {}", name, error.what()));
  }
}

std::optional<Recipe> read_recipe(const std::filesystem::path& picture) {
  const auto text = read_picture_text(picture);
  if (!text) return std::nullopt;
  return Recipe::parse(*text, picture.string());
}

}  // namespace nutik
