// Projects: what is saved, whatever comes in between, and what is not replaced.
#include "studio/window/project_file.hpp"

#include <gtest/gtest.h>

#include <QFile>
#include <set>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "studio/regions/region_edits.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::studio {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kAcross = 8, kDown = 6;

CaptureFacts small_facts(const QString& capture) {
  return {capture, {.shape = {kAcross, kDown, 3}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100)};
}

// Functions, mask and looks that all differ from those of another number.
void change(Document& document, int number) {
  add_region(document);
  paint_region(document, rectangle(kAcross, kDown, {0, 0}, number, number), document.selected_tag(),
               "Rectangle");
  for (const auto& [tag, function] : FunctionSet(document.functions()))
    document.set_points(tag, {{0, 0.5 * number}, {1'000, 1.0 * number}}, "Move point");
  set_look(document, document.selected_tag(), {QString("Region %1").arg(number), QColor("#c08040"), true},
           "Look");
}

class ProjectFile : public testing::Test {
 protected:
  [[nodiscard]] QString path(const std::string& name) const {
    return QString::fromStdString((scratch_ / name).string());
  }
  // The state that is saved as `name`.
  DocumentState save(const std::string& name, int number, const CommandFiles& files) {
    Document document;
    document.start(small_facts(path("clip.tik")));
    change(document, number);
    save_project(path(name), document, files);
    return document.state();
  }
  DocumentState save(const std::string& name, int number) {
    return save(name, number, free_files_beside(path(name)));
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return test::read_file(scratch_ / name);
  }

  test::Scratch scratch_;
};

// Wherever a save is ended, the project is as it was or as it was to be, and the next save goes through.
TEST_F(ProjectFile, IsTheOldOneOrTheNewOneWhereverASaveEnds) {
  const fs::path tests = fs::path(NUTIK_TEST_PROGRAM).parent_path() / "tests";
  const auto saves = [&](const char* call, int at, const char* error) {
    return test::run_shell(
               format("LD_PRELOAD='{}' NUTIK_FAIL_FOLDER='{}' NUTIK_FAIL_CALL={} NUTIK_FAIL_AT={} "
                      "NUTIK_FAIL_ERROR={} NUTIK_FAIL_AFTER=on '{}' --save '{}'",
                      (tests / "libfail_calls.so").string(), scratch_.folder().string(), call, at, error,
                      (tests / "nutik_studio_tests").string(), (scratch_ / "p.nutik").string()),
               scratch_.folder())
               .status == 0;
  };
  const std::vector<std::string> names{"p.nutik", "p.fn", "p.pgm"};
  const DocumentState wanted = save("p.nutik", 5);  // as another process saves it
  for (const bool is_first : {true, false}) {
    for (const auto& [call, error] :
         {std::pair("rename", "kill"), std::pair("rename", "28"), std::pair("fsync", "kill"),
          std::pair("write", "28"), std::pair("write", "kill"), std::pair("open", "28")}) {
      int as_before = 0, as_after = 0, is_said = 0;
      for (int at = 1;; ++at) {
        for (const std::string& name : names) fs::remove(scratch_ / name);
        const DocumentState before = is_first ? DocumentState() : save("p.nutik", 3);
        if (saves(call, at, error)) break;
        const std::string where = format("{} {} {} {}", call, at, error, is_first ? "first" : "later");
        if (is_first && !fs::exists(scratch_ / "p.nutik")) {
          ++as_before;
          EXPECT_FALSE(fs::exists(scratch_ / "p.fn") || fs::exists(scratch_ / "p.pgm")) << where;
        } else {
          const Project found = load_project(path("p.nutik"));
          const bool is_new = found.state == wanted;
          EXPECT_TRUE(is_new || (!is_first && found.state == before)) << where;
          ++(is_new ? as_after : as_before);
          is_said += is_new && found.is_unwritten;
        }
        ASSERT_TRUE(saves("rename", 0, "28")) << where;
        const Project again = load_project(path("p.nutik"));
        EXPECT_TRUE(again.state == wanted && !again.is_unwritten) << where;
        EXPECT_EQ(again.files.functions, path("p.fn")) << where;
        EXPECT_EQ(load_functions(path("p.fn")), wanted.functions) << where;
        EXPECT_TRUE(load_mask(path("p.pgm"))->mask == (*wanted.mask)->mask) << where;
      }
      EXPECT_GE(as_before, 1) << call << " " << error;
      EXPECT_GE(as_after, std::string_view(call) == "write" ? 2 : 3) << call << " " << error;
      EXPECT_GE(is_said, 2) << call << " " << error;
    }
  }
}

TEST_F(ProjectFile, ReplacesNothingBesideItThatIsOfOthers) {
  const char* mine = "M0 [0:1]\n";
  const std::string picture = "P5 8 6 255\n" + std::string(48, 'a');
  const auto is_kept = [&] { return content("p.fn") == mine && content("p.pgm") == picture; };
  scratch_.write("p.fn", mine);
  scratch_.write("p.pgm", picture);
  fs::create_symlink("nowhere", scratch_ / "p-2.pgm");
  const DocumentState saved = save("p.nutik", 3);
  EXPECT_TRUE(is_kept());
  EXPECT_FALSE(fs::exists(scratch_ / "nowhere"));
  const Project project = load_project(path("p.nutik"));
  EXPECT_TRUE(project.state == saved);
  EXPECT_EQ(project.files.functions, path("p-3.fn"));
  EXPECT_EQ(project.files.mask, path("p-3.pgm"));
  EXPECT_EQ(foreign_files(path("p.nutik"), project.files), QStringList());
  save("p.nutik", 4);
  EXPECT_EQ(load_project(path("p.nutik")).files.functions, path("p-3.fn")) << "its own are replaced";
  EXPECT_TRUE(is_kept());
  EXPECT_EQ(free_files_beside(path("%02d.nutik"), path("%02d.pgm")).mask, path("%02d-2.pgm")) << "the capture's name";
  // Another one whose name is of the same beginning, and a copy, which names what the first has.
  save("p.x.nutik", 2);
  fs::copy_file(scratch_ / "p.nutik", scratch_ / "copy.nutik");
  EXPECT_EQ(foreign_files(path("copy.nutik"), project.files), QStringList({path("p-3.fn"), path("p-3.pgm")}));
}

// Neither a name nor what anybody may write into a project shows that a file is the project's.
TEST_F(ProjectFile, IsNotBelievedWhatFilesAreItsOwn) {
  save("other.nutik", 3);
  save_mask(path("plain.pgm"), Mask::uniform(kAcross, kDown, 0));
  save_functions(path("plain.fn"), FunctionSet{{0, GainFunction::boxcar(0, 1'000)}});
  const std::string line =
      R"({"nutik-studio": 1, "id": "%ID%", "capture": "clip.tik", "functions": "plain.fn"})";
  for (const char* id : {"", "1", "of the nutik-studio project"}) {
    std::string text = line;
    scratch_.write("p.nutik", text.replace(text.find("%ID%"), 4, id));
    for (const char* stem : {"plain", "other"}) {
      const CommandFiles files{path(format("{}.pgm", stem)), path(format("{}.fn", stem))};
      EXPECT_EQ(foreign_files(path("p.nutik"), files).size(), 2) << id << " " << stem;
    }
  }
}

// Nor where they are to be, of those that are not there.
TEST_F(ProjectFile, WritesNoNewFileElsewhere) {
  scratch_.write("p.nutik",
                 R"({"nutik-studio": 1, "capture": "clip.tik", "functions": "sub/x", "mask": "/tmp/none.pgm",
    "unwritten": {"functions": "M0 [0:1]\n"}, "exposes": "interval", "start_ns": "0", "length_ns": "5",
    "normalize": "support", "feather": "0px"})");
  const Project project = load_project(path("p.nutik"));
  EXPECT_TRUE(project.is_unwritten);
  EXPECT_EQ(project.files.functions, path("p.fn"));
  EXPECT_EQ(project.files.mask, path("p.pgm"));
}

TEST_F(ProjectFile, SaysWhatIsDamagedInOneThatHoldsAll) {
  Document document;
  document.start(small_facts(path("clip.tik")));
  change(document, 3);
  keep_project(path("p.nutik"), document);
  EXPECT_TRUE(load_project(path("p.nutik")).state == document.state());
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch_.folder()), {}), 1) << "one file";
  const std::string whole = content("p.nutik");
  const auto refused = [&](const std::string& what, const std::string& by, const std::string& words) {
    std::string text = whole;
    text.replace(text.find(what), what.size(), by);
    scratch_.write("p.nutik", text);
    SCOPED_TRACE(by);
    test::expect_error<InputError>([&] { static_cast<void>(load_project(path("p.nutik"))); }, {words});
  };
  refused("\"width\": 8", "\"width\": 9", "the mask in it is damaged");
  refused("\"width\": 8", "\"width\": -8", "its mask's width is not from 1 to 32767");
  refused("\"tags\": \"", "\"tags\": \"AAAA", "the mask in it is damaged");
  refused("M0 [", "M0 [x", "has mistakes");
  const std::string ev = "\"ev\": 0", exposes = "\"exposes\": \"regions\"";
  refused(ev, "\"ev\": \"2\"", "'ev' is no number");
  refused(ev, "\"ev\": 18", "'ev' is not from -16 to 16");
  refused(ev, ev + ", \"fps\": true", "'fps' is no text");
  refused(ev, ev + ", \"deflicker\": 1", "'deflicker' is neither true nor false");
  refused(exposes, "\"exposes\": \"region\"", "'exposes' is neither 'interval' nor 'regions'");
  refused(exposes, "\"exposes\": 1", "'exposes' is no text");
  refused("\"visible\": true", "\"visible\": \"no\"", "'visible' is neither true nor false");
  refused("\"regions\": [", "\"regions\": 1, \"others\": [", "'regions' is no list");
  std::string text = whole;
  scratch_.write("p.nutik", text.replace(text.find(ev), ev.size(), "\"ev\": -16, \"fps\": 29.97"));
  EXPECT_EQ(load_project(path("p.nutik")).stated, (Stated{{"fps", "29.97"}}));
}

}  // namespace

// What another process does, so that it can be ended anywhere: saves what it finds, or nothing yet, with other regions.
int save_changed(const char* project) {
  const QString path = QFile::decodeName(project);
  Document document;
  document.start(small_facts(QFileInfo(path).dir().filePath("clip.tik")));
  change(document, 5);
  try {
    save_project(path, document, free_files_beside(path));
    return 0;
  } catch (const OutputError&) {
    return 5;
  }
}

}  // namespace nutik::studio
