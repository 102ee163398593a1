// The window in German: nothing of it is left in English, and no file and no command knows of it.
#include <QComboBox>
#include <QCommandLinkButton>
#include <QDialogButtonBox>
#include <QFile>
#include <QFormLayout>
#include <QLabel>
#include <QLibraryInfo>
#include <QTranslator>
#include <set>

#include "studio/regions/region_edits.hpp"
#include "studio/window/appearance.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

// Is asked last, for what nobody else has translated.
class Missing : public QTranslator {
 public:
  QString translate(const char* context, const char* words, const char*, int) const override {
    if (QString(context).startsWith("nutik") || QString(context) == "Option") texts_ += words;
    return {};
  }
  [[nodiscard]] bool isEmpty() const override { return false; }  // else it is not asked
  [[nodiscard]] std::string texts() const { return texts_.join('\n').toStdString(); }

 private:
  mutable QStringList texts_;
};

// Before there is a window.
struct German {
  German() {
    QCoreApplication::installTranslator(&missing_);
    use_language({"de-AT", "en"});
  }
  ~German() { forget(); }
  static void forget() { qDeleteAll(QCoreApplication::instance()->findChildren<QTranslator*>()); }
  Missing missing_;
};

class LanguageTest : public German, public StudioTest {
 protected:
  void SetUp() override {
    if (!QFile::exists(":/translations/nutik_studio_de.qm")) GTEST_SKIP() << "built without Qt's lrelease";
  }
  // What a person draws, as files and a command line have it; without names, which are a person's own, and the numbers
  // that each project has.
  static std::string written(MainWindow& window, const QString& folder) {
    QDir().mkpath(folder);
    const QString names = QString("\"(%1|%2)\"|project [0-9a-f]+|\"id\": .*")
                              .arg(Document::tr("Background"), Document::tr("Region %1").arg(1));
    add_region(window.document());
    const Shape& shape = window.document().facts()->format.shape;
    paint_region(window.document(), ellipse(shape.width, shape.height, {12, 8}, 5, 5),
                 window.document().selected_tag(), "Ellipse");
    set_feather(window.document(), 150);
    window.document().set_points(0, {{0, 0.5}, {2'500'000, 1.25}}, "Points");
    EXPECT_TRUE(window.save_project(folder + "/drawn.nutik")) << window.notice().text().toStdString();
    QString all = window.command_for("picture.png").replace(folder, "FOLDER");
    for (const QString& name : QDir(folder).entryList(QDir::Files)) {
      QFile file(folder + "/" + name);
      EXPECT_TRUE(file.open(QIODevice::ReadOnly));
      all += "\n" + name + "\n" + QString::fromLatin1(file.readAll()).replace(QRegularExpression(names), "NAME");
    }
    return all.toStdString();
  }
  static std::set<QString> object_names(const MainWindow& window) {
    std::set<QString> names;
    for (const QObject* object : window.findChildren<QObject*>()) names.insert(object->objectName());
    return names;
  }
};

void expect_own_letters(const QList<QAction*>& rows, const QString& menu) {
  std::set<QChar> letters;
  for (const QAction* row : rows) {
    const qsizetype at = row->text().indexOf(QRegularExpression("&[^&]"));
    const bool is_own = at < 0 || letters.insert(row->text()[at + 1].toLower()).second;
    EXPECT_TRUE(is_own) << menu.toStdString() << ": " << row->text().toStdString();
    if (row->menu() != nullptr) expect_own_letters(row->menu()->actions(), row->text());
  }
}

TEST_F(LanguageTest, TheWindowIsGermanAndEachMenusLettersAreItsOwn) {
  open_clip();
  QStringList menus;
  for (const QAction* title : window_.menuBar()->actions()) menus += title->text().remove('&');
  EXPECT_EQ(menus.join(' ').toStdString(), "Datei Bearbeiten Regionen Start mit Ansicht Hilfe");
  expect_own_letters(window_.menuBar()->actions(), "menu bar");
  EXPECT_EQ(child<QLineEdit>("width").accessibleName(), "Länge");
  for (const char* dialog :
       {"Bild exportieren…", "Film exportieren…", "Studie mit Optionen…", "Wie der Clip gelesen wird…"}) {
    answer_next<QDialog>([&](QDialog& asked) {
      for (const QLabel* label : asked.findChildren<QLabel*>()) EXPECT_FALSE(label->text().startsWith("How"));
      const QString cancel = asked.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel)->text();
      const bool has_qts = QFile::exists(QLibraryInfo::path(QLibraryInfo::TranslationsPath) + "/qtbase_de.qm");
      EXPECT_EQ(cancel.contains("Abbrechen"), has_qts) << cancel.toStdString();
      if (auto* style = asked.findChild<QComboBox*>("style")) {
        EXPECT_EQ(style->itemText(0), "Bewegungsstudie");
        EXPECT_EQ(style->findText("eingefrorenes Motiv"), style->findData("frozen"));
        EXPECT_EQ(asked.findChild<QComboBox*>("trail")->itemText(0), "passend zum Bild");
      }
      if (auto* from = asked.findChild<QLineEdit*>("from")) {
        from->setText("bald");
        QTest::keyClick(from, Qt::Key_Return);
        const QString said = asked.findChild<QLabel*>("mistake")->text();
        EXPECT_TRUE(said.startsWith("Wo in der Aufnahme der Film beginnt: 'bald'")) << said.toStdString();
        QApplication::processEvents();
        for (const QLabel* label : asked.findChildren<QLabel*>())
          EXPECT_TRUE(label->isHidden() || label->height() >= label->heightForWidth(label->width()))
              << label->text().toStdString();
      }
      asked.reject();
    });
    for (QAction* action : window_.findChildren<QAction*>())
      if (action->text().remove('&') == dialog) action->trigger();
    EXPECT_TRUE(is_asked_) << dialog;
  }
  EXPECT_EQ(missing_.texts(), "");
}

TEST_F(LanguageTest, TheStartPageFitsASmallWindow) {
  window_.resize(800, 500);
  QApplication::processEvents();
  EXPECT_EQ(window_.size(), QSize(800, 500));
  const auto cards = child<QWidget>("start_page").findChildren<QCommandLinkButton*>();
  ASSERT_EQ(cards.size(), 7);
  for (const auto* card : cards) {
    EXPECT_GE(card->height(), card->heightForWidth(card->width())) << card->text().toStdString();
    for (const auto* other : cards) EXPECT_TRUE(card == other || !card->geometry().intersects(other->geometry()));
  }
}

TEST_F(LanguageTest, WhatIsTypedWrongIsSaidInGermanWithTheFieldsName) {
  open_clip();
  const std::pair<const char*, const char*> fields[] = {
      {"start", "Start: 'bald' ist"}, {"width", "Länge: 'bald' ist"}, {"in", "In: 'bald' ist"}};
  for (const auto& [name, said] : fields) {
    type_into(child<QLineEdit>(name), "bald");
    EXPECT_TRUE(window_.notice().text().startsWith(said)) << window_.notice().text().toStdString();
  }
  EXPECT_EQ(missing_.texts(), "");
}

TEST_F(LanguageTest, FilesCommandsAndNamesOfObjectsAreTheSame) {
  open_clip();
  const std::string german = written(window_, path("german"));
  const std::set<QString> names = object_names(window_);
  EXPECT_EQ(document().state().looks.at(0).name, "Hintergrund");
  forget();
  MainWindow english{ComputingRequest()};
  english.show();
  open_in(english);
  EXPECT_EQ(object_names(english), names);
  EXPECT_EQ(written(english, path("english")), german);
}

TEST_F(LanguageTest, TheFirstLanguageThatIsKnownCounts) {
  forget();
  use_language({"en-GB", "de"});
  EXPECT_EQ(MainWindow::tr("&File"), "&File");
  use_language({"tlh", "de-DE"});
  EXPECT_EQ(MainWindow::tr("&File"), "&Datei");
}

}  // namespace
}  // namespace nutik::studio
