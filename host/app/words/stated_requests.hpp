// The session and its requests, as the words of a command line state them.
//
//   always:  contradicting options are refused as UsageError before anything large is read. Function files and masks
//            are read here: InputError with all mistakes of a text; warnings are printed
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line/command_table.hpp"
#include "features/film/film_request.hpp"
#include "features/masks/mask_request.hpp"
#include "features/recipe/picture_recipe.hpp"
#include "features/schema/options.hpp"
#include "features/schema/requests.hpp"
#include "session/devices.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/requests/source_request.hpp"
#include "session/session.hpp"

namespace nutik::app {

// How the clip or capture of this name is to be read. What describes a clip is refused for a .tik.
[[nodiscard]] SourceRequest source_request(const Options& options, const std::string& name);

// What was stated, as 500MB, 2GB or 1GiB; else half of the machine's memory.
[[nodiscard]] MemoryBudget memory_budget(const Options& options);
// What computes, not started yet. Kernels that are built are told of, unless --quiet.
[[nodiscard]] std::shared_ptr<Devices> make_devices(const Options& options);

// A session on the first operand; its devices start beside it. A clip that is read whole is read with a progress bar,
// which says `what` is done. Prints what is doubtful about what came of it. Throws UsageError where options describe a
// clip and this is a .tik, and what Session throws.
[[nodiscard]] Session open_session(const Options& options, Session::Terms terms = {}, const char* what = "reading");
// On another capture, with devices that start when the first picture is asked for.
[[nodiscard]] Session open_session(const std::string& name, const Options& options,
                                   std::shared_ptr<Devices> devices, Session::Terms terms = {},
                                   const char* what = "reading");

// That the camera of a capture moved and nobody aligned it, as a note.
[[nodiscard]] std::vector<std::string> camera_notes(const std::optional<MovedCamera>& moved);

// Throws UsageError where an option says something of a mask that is not there.
void refuse_without_mask(const Options& options);
[[nodiscard]] ExposureRequest exposure_request(const Options& options);
// With functions that -k only names.
[[nodiscard]] ExposureRequest exposure_request(const Options& options, const Shared<FunctionSet>& functions);
// For naming the picture: `FnFile`, `0.4s-10ms`.
[[nodiscard]] std::string exposure_label(const Options& options);

// The many exposures of a video.
[[nodiscard]] FramesRequest frames_request(const Options& options);

// The stated mask, on its way to the second one and with blended edges where that was asked for; of layers the tag
// `rest` gets what they leave.
[[nodiscard]] Mask exposure_mask(const Options& options, std::uint8_t rest);
// The file that it is, or both and what lies between them.
[[nodiscard]] std::string exposure_mask_name(const Options& options);

// What was stated of the clip and of the picture, as far as another command knows it: as words of that.
[[nodiscard]] std::string stated_words(const Options& options, CommandId command);

// What a mask is made of:
//
//   --tag 128 --moving --largest --grow 4 --tag 255 --ellipse 320,180,40,30
//
// selects what moves, keeps its largest part, grows that by 4 pixels and gives it tag 128; then an ellipse gets
// tag 255, over what it covers. Pictures have their names and nothing else, and there is no base, until read_inputs().
[[nodiscard]] MaskRequest mask_request(const Options& options);
void read_inputs(MaskRequest& request, const Options& options);
// As mask_request() reads it.
[[nodiscard]] std::string change_words(const RegionChange& change);

// What the recipes of a command's pictures have in common; none with --no-recipe.
[[nodiscard]] std::optional<RecipeSources> recipe_sources(const Options& options, RecipeOf of = RecipeOf::expose);
// What the recipe of a sweep's picture states in place of the sweep's options.
[[nodiscard]] OwnRecipe own_recipe(const OwnExposure& exposure);
// Whether such a recipe may state this option with this value: it makes the picture, and stands in no other place of
// the recipe.
[[nodiscard]] bool is_recipe_option(std::string_view long_name, std::string_view value, RecipeOf of);

}  // namespace nutik::app
