#include "studio/window/start_page.hpp"

#include <QBuffer>
#include <QCommandLinkButton>
#include <QFileInfo>
#include <QGridLayout>
#include <QImage>
#include <QLabel>
#include <QListWidget>
#include <QPainter>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QVBoxLayout>

#include "studio/window/started_work.hpp"

namespace nutik::studio {
namespace {

constexpr const char *kRecentKey = "recent", *kPicturesKey = "recent_pictures";
constexpr int kMaxRecent = 10;
constexpr QSize kPicture(160, 90), kCard(72, 40);

// A ball on its way from left to right, as this starting point shows it.
QImage drawn(std::optional<StudyStyle> style) {
  QImage image(2 * kCard, QImage::Format_RGB32);
  image.fill(QColor(58, 64, 70));
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const QColor ball(238, 168, 84);
  const double right = image.width() - 26;
  const auto place = [&](double way) { return QPointF(26 + way * (right - 26), 30 + 28 * way * way); };
  const bool has_trail = !style || style == StudyStyle::trail || style == StudyStyle::rear_curtain;
  for (int step = 0; has_trail && step <= 200; ++step) {
    const double way = step / 200.0;
    painter.setBrush(QColor(238, 168, 84, style == StudyStyle::rear_curtain ? static_cast<int>(16 * way) : 9));
    painter.drawEllipse(place(way), 11, 11);
  }
  painter.setBrush(ball);
  const bool is_several = style == StudyStyle::trail || style == StudyStyle::strobe;
  for (const double way : {0.0, 0.5, 1.0})
    if (is_several || (style == StudyStyle::frozen && way == 0.5) || (style == StudyStyle::rear_curtain && way == 1))
      painter.drawEllipse(place(way), 12, 12);
  for (int strip = 0; style == StudyStyle::slit && strip < 9; ++strip) {
    painter.setClipRect(QRect(strip * 16, 0, 15, image.height()));
    painter.fillRect(image.rect(), QColor(70, 78, 86));
    painter.drawEllipse(QPointF(72, 16 + 6 * strip), 30, 12);
  }
  if (style == StudyStyle::clean) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(QColor(150, 150, 150), 2, Qt::DotLine));
    painter.drawEllipse(place(0.5), 12, 12);
  }
  return image;
}

}  // namespace

QList<RecentFile> recent_files() {
  const QVariantMap pictures = QSettings().value(kPicturesKey).toMap();
  QList<RecentFile> files;
  for (const QString& path : QSettings().value(kRecentKey).toStringList())
    files += {path, QImage::fromData(pictures.value(path).toByteArray())};
  return files;
}

void remember_file(const QString& path) {
  QSettings settings;
  QStringList recent = settings.value(kRecentKey).toStringList();
  const QString absolute = QFileInfo(path).absoluteFilePath();
  recent.removeAll(absolute);
  recent.prepend(absolute);
  settings.setValue(kRecentKey, recent.mid(0, kMaxRecent));
}

void remember_picture(const QString& path, const QImage& picture) {
  QSettings settings;
  const QVariantMap before = settings.value(kPicturesKey).toMap();
  QVariantMap pictures;
  for (const RecentFile& file : recent_files())
    if (before.contains(file.path)) pictures[file.path] = before[file.path];
  QByteArray bytes;
  QBuffer buffer(&bytes);
  picture.scaled(2 * kPicture, Qt::KeepAspectRatio, Qt::SmoothTransformation).save(&buffer, "JPG");
  pictures[QFileInfo(path).absoluteFilePath()] = bytes;
  settings.setValue(kPicturesKey, pictures);
}

StartPage::StartPage(QWidget* parent) : QWidget(parent), recent_(new QListWidget(this)) {
  setObjectName("start_page");
  setAutoFillBackground(true);
  auto* open = new QPushButton(tr("Open a clip or a capture…"), this);
  open->setToolTip(tr("Ctrl+O; or drop one here"));
  connect(open, &QPushButton::clicked, this, &StartPage::asked_for_clip);
  auto* cards = new QGridLayout;
  cards->setColumnStretch(3, 1);
  int card = 0;
  for (const StartingPoint& point : starting_points()) {
    auto* button = new QCommandLinkButton(Document::tr(point.name).remove('&'), Document::tr(point.tip), this);
    button->setToolTip(tr("Opens a clip, and makes this of it"));
    button->setIcon(QPixmap::fromImage(drawn(point.style)));
    button->setIconSize(kCard);
    connect(button, &QPushButton::clicked, this, [this, &point] { Q_EMIT started(point); });
    button->setMinimumWidth(280);
    cards->addWidget(button, card / 3, card % 3);
    ++card;
  }
  recent_->setObjectName("recent");
  recent_->setAccessibleName(tr("Recent work"));
  recent_->setViewMode(QListView::IconMode);
  recent_->setMovement(QListView::Static);
  recent_->setResizeMode(QListView::Adjust);
  recent_->setIconSize(kPicture);
  recent_->setGridSize(kPicture + QSize(12, 30));
  recent_->setTextElideMode(Qt::ElideMiddle);
  recent_->setFrameShape(QFrame::NoFrame);
  recent_->setStyleSheet("activate-on-singleclick: 1");  // as the cards are
  connect(recent_, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) {
    Q_EMIT chosen(item->toolTip());
  });
  auto* page = new QWidget;
  auto* area = new QScrollArea;  // cards in a small window would cover each other
  area->setWidget(page);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(area);
  auto* column = new QVBoxLayout(page);
  column->setContentsMargins(32, 56, 32, 16);  // below what is said
  column->addWidget(open, 0, Qt::AlignLeft);
  column->addLayout(cards);
  column->addWidget(new QLabel(tr("Recent work"), this));
  column->addWidget(recent_, 1);
}

void StartPage::showEvent(QShowEvent*) {
  recent_->clear();
  for (const RecentFile& file : recent_files()) {
    if (!QFileInfo::exists(file.path) && !is_pattern(file.path)) continue;
    QPixmap pixmap = QPixmap::fromImage(file.picture);
    if (pixmap.isNull()) {
      pixmap = QPixmap(kPicture);
      pixmap.fill(palette().color(QPalette::Mid));
    }
    auto* item = new QListWidgetItem(QIcon(pixmap), QFileInfo(file.path).fileName(), recent_);
    item->setToolTip(file.path);
  }
}

}  // namespace nutik::studio
