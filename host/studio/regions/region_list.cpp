#include "studio/regions/region_list.hpp"

#include <QColorDialog>
#include <QFormLayout>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QScopedValueRollback>
#include <QStyledItemDelegate>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/error.hpp"
#include "studio/regions/region_edits.hpp"

namespace nutik::studio {
namespace {

constexpr int kTagRole = Qt::UserRole;
constexpr double kMaxRadius = 100, kMaxFeather = 100;  // pixels
constexpr double kAsAll = 0.5;                         // less than none: a region has no feather of its own

// For columns that tell what cannot be edited there.
class NoEditor : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  QWidget* createEditor(QWidget*, const QStyleOptionViewItem&, const QModelIndex&) const override {
    return nullptr;
  }
};

QIcon swatch(const QColor& colour) {
  QPixmap pixmap(32, 32);
  pixmap.setDevicePixelRatio(2);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawRoundedRect(QRectF(2, 2, 12, 12), 3, 3);
  return pixmap;
}

std::uint8_t tag_of(const QTreeWidgetItem& item) {
  return static_cast<std::uint8_t>(item.data(0, kTagRole).toUInt());
}

// Nothing where it is not known.
std::optional<double> still_gain(const DocumentState& state, std::uint8_t tag, std::int64_t duration_ns) {
  try {
    return exposed_summary(state, tag, duration_ns).still_gain();
  } catch (const InputError&) {
    return {};
  }
}

QString stops_text(double stops) {
  return std::abs(stops) < 0.05 ? QStringLiteral("0.0") : QString::asprintf("%+.1f", stops);
}

QDoubleSpinBox* pixel_box(const char* object, double most, double value, const QString& name, QWidget* parent) {
  auto* box = new NumberBox(parent);
  box->setRange(0, most);
  box->setDecimals(1);
  box->setSuffix(QStringLiteral(" px"));
  box->setValue(value);
  describe(*box, object, name);
  return box;
}

}  // namespace

void describe(QWidget& widget, const char* object, const QString& name, const QString& tip) {
  widget.setObjectName(object);
  widget.setAccessibleName(name);
  widget.setAccessibleDescription(tip);
  widget.setToolTip(tip.isEmpty() ? name : tip);
}

RegionList::RegionList(Document& document, QWidget* parent)
    : QWidget(parent), document_(document), list_(new QTreeWidget(this)) {
  list_->setObjectName("regions");
  list_->setAccessibleName(tr("Regions"));
  list_->setColumnCount(kColumns);
  list_->setHeaderLabels({tr("Region"), tr("EV"), tr("Still"), tr("Clipped"), tr("Solo")});
  list_->headerItem()->setToolTip(kEv, tr("The same in stops: 0 is as bright as the capture, −1 half as bright"));
  list_->headerItem()->setToolTip(kStill, tr("What light that does not change is multiplied by"));
  list_->headerItem()->setToolTip(kClipped, tr("How many of its pixels have light beyond white, which no code shows"));
  list_->headerItem()->setToolTip(kSolo, tr("Darkens all other regions"));
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  list_->header()->setStretchLastSection(false);
  list_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
  for (const int column : {kEv, kStill, kClipped, kSolo}) {
    list_->header()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
    list_->setItemDelegateForColumn(column, new NoEditor(list_));
  }
  build_buttons();
  connect(list_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    if (!is_following_ && item != nullptr) document_.select_tag(tag_of(*item));
  });
  connect(list_, &QTreeWidget::itemChanged, this, &RegionList::edited);
  connect(&document_, &Document::changed, this, [this] {
    // An interval that is moved, or pixels that are painted, are none of the list's.
    DocumentState listed = document_.state();
    listed.boxcar = listed_.boxcar;
    listed.mask = listed_.mask;
    listed.covered = listed_.covered;
    if (!(listed == listed_)) follow();
  });
  connect(&document_, &Document::capture_changed, this, [this] {
    clipped_.fill(0);
    follow();
  });
  connect(&document_, &Document::selection_changed, this, &RegionList::follow_selection);
  follow();
}

void RegionList::build_buttons() {
  const auto button = [&](const char* object, const QString& text, const QString& tip, auto run) {
    auto* made = new QPushButton(text, this);
    describe(*made, object, {}, tip);
    connect(made, &QPushButton::clicked, this, run);
    return made;
  };
  add_ = button("add_region", tr("Add"), tr("A new region, exposed over the interval; paint it with a tool"),
                [this] { add_region(document_); });
  remove_ = button("remove_region", tr("Remove"), tr("Its pixels fall to the background"),
                   [this] { remove_region(document_, document_.selected_tag()); });
  colour_ = button("region_colour", tr("Colour…"), tr("Of the region's outline and curve"),
                   [this] { choose_colour(); });
  up_ = button("region_up", tr("Up"), tr("Before the region above it, which it then covers"),
               [this] { move_region(document_, document_.selected_tag(), Move::up); });
  down_ = button("region_down", tr("Down"), tr("Behind the region below it, which then covers it"),
                 [this] { move_region(document_, document_.selected_tag(), Move::down); });
  over_interval_ = button("over_interval", tr("Interval"),
                          tr("The interval of the time strip becomes the region's function"),
                          [this] { expose_over_boxcar(document_, document_.selected_tag()); });
  grow_ = button("grow", tr("Grow"), tr("By so many pixels"),
                 [this] { grow_region(document_, document_.selected_tag(), radius_->value()); });
  shrink_ = button("shrink", tr("Shrink"), tr("By so many pixels"),
                   [this] { grow_region(document_, document_.selected_tag(), -radius_->value()); });
  smooth_ = button("smooth", tr("Smooth"), tr("Without parts and holes narrower than twice that"),
                   [this] { smooth_region(document_, document_.selected_tag(), radius_->value()); });
  radius_ = pixel_box("radius", kMaxRadius, 2, tr("Pixels to grow, shrink or smooth by"), this);
  feather_ = pixel_box("feather", kMaxFeather, 0, tr("Feather: how far all edges are blended, to either side"), this);
  own_feather_ = pixel_box("own_feather", kMaxFeather, 0, tr("Feather of the selected region's own edges"), this);
  own_feather_->setRange(-kAsAll, kMaxFeather);
  own_feather_->setSingleStep(kAsAll);
  own_feather_->setSpecialValueText(tr("as all edges"));
  for (QDoubleSpinBox* box : {feather_, own_feather_}) box->setKeyboardTracking(false);

  auto* buttons = new QGridLayout;
  buttons->setSpacing(4);
  int place = 0;
  for (QPushButton* each : {add_, remove_, colour_, up_, down_, over_interval_, grow_, shrink_, smooth_}) {
    buttons->addWidget(each, place / 3, place % 3);
    ++place;
  }
  auto* numbers = new QFormLayout;
  numbers->addRow(tr("Grow by"), radius_);
  numbers->addRow(tr("Feather edges"), feather_);
  numbers->addRow(tr("Own edges"), own_feather_);
  for (QDoubleSpinBox* box : {radius_, feather_, own_feather_})
    numbers->labelForField(box)->setToolTip(box->toolTip());
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(list_, 1);
  column->addLayout(buttons);
  column->addLayout(numbers);

  connect(feather_, &QDoubleSpinBox::valueChanged, this, [this](double pixels) {
    if (!is_following_) set_feather(document_, qRound(pixels * 100));
  });
  connect(own_feather_, &QDoubleSpinBox::valueChanged, this, [this](double pixels) {
    if (is_following_) return;
    set_feather_of(document_, document_.selected_tag(),
                   pixels < 0 ? std::nullopt : std::optional(qRound(pixels * 100)));
  });
}

void RegionList::follow() {
  const QScopedValueRollback guard(is_following_, true);
  listed_ = document_.state();
  std::vector<std::uint8_t> tags = listed_.order;
  if (document_.functions().contains(kBackground)) tags.push_back(kBackground);
  bool is_same = list_->topLevelItemCount() == static_cast<int>(tags.size());
  for (int row = 0; is_same && row < list_->topLevelItemCount(); ++row)
    is_same = tag_of(*list_->topLevelItem(row)) == tags[static_cast<std::size_t>(row)];
  if (!is_same) {
    list_->clear();
    for (const std::uint8_t tag : tags) {
      auto* item = new QTreeWidgetItem(list_);
      item->setData(0, kTagRole, tag);
      item->setFlags(item->flags() | Qt::ItemIsEditable | Qt::ItemIsUserCheckable);
    }
  }
  for (int row = 0; row < list_->topLevelItemCount(); ++row)
    fill(*list_->topLevelItem(row), tags[static_cast<std::size_t>(row)]);
  const bool is_clipped = std::ranges::any_of(clipped_, [](std::uint64_t pixels) { return pixels > 0; });
  list_->setColumnHidden(kClipped, !is_clipped);
  list_->setColumnHidden(kEv, is_clipped);  // names need room, and Still says the same
  feather_->setValue(document_.state().feather.everywhere_centipixels / 100.0);
  follow_selection();
}

void RegionList::follow_selection() {
  const QScopedValueRollback guard(is_following_, true);
  for (int row = 0; row < list_->topLevelItemCount(); ++row) {
    QTreeWidgetItem& item = *list_->topLevelItem(row);
    if (tag_of(item) == document_.selected_tag()) list_->setCurrentItem(&item);
    item.setCheckState(kSolo, document_.solo() == tag_of(item) ? Qt::Checked : Qt::Unchecked);
  }
  const bool is_open = document_.facts() != nullptr;
  const std::uint8_t tag = document_.selected_tag();
  const bool can_change = is_open && tag != kBackground;
  const auto& own = document_.state().feather.of_tag;
  own_feather_->setValue(own.contains(tag) ? own.at(tag) / 100.0 : own_feather_->minimum());
  for (QWidget* widget : std::initializer_list<QWidget*>{add_, colour_, over_interval_, feather_, own_feather_})
    widget->setEnabled(is_open);
  for (QPushButton* button : {remove_, grow_, shrink_, smooth_}) button->setEnabled(can_change);
  const std::vector<std::uint8_t>& order = document_.state().order;
  up_->setEnabled(can_change && !order.empty() && order.front() != tag);
  down_->setEnabled(can_change && !order.empty() && order.back() != tag);
}

void RegionList::fill(QTreeWidgetItem& item, std::uint8_t tag) const {
  const auto look = document_.state().looks.find(tag);
  if (look == document_.state().looks.end()) return;
  item.setText(kName, look->second.name);
  item.setIcon(kName, swatch(look->second.colour));
  item.setCheckState(kName, look->second.is_visible ? Qt::Checked : Qt::Unchecked);
  item.setToolTip(kName, "<qt>" + tr("%1, M%2 in mask and function file. Checked: its outline and its curve are shown")
                             .arg(look->second.name.toHtmlEscaped(), QString::number(tag)));
  const auto still = still_gain(document_.state(), tag, document_.duration_ns());
  item.setText(kStill, still ? QStringLiteral("%1×").arg(*still, 0, 'f', 2) : QStringLiteral("–"));
  item.setText(kEv, still && *still > 0 ? stops_text(std::log2(*still)) : QStringLiteral("–"));
  item.setText(kClipped, clipped_[tag] == 0 ? QString() : QString::number(clipped_[tag]));
  for (const int column : {kEv, kStill, kClipped}) item.setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
}

void RegionList::count_clipped(const MeasuredLight& light) {
  clipped_.fill(0);
  for (const auto& [tag, pixels] : light.saturated) clipped_[tag] = pixels.above;
  follow();
}

void RegionList::edited(QTreeWidgetItem* item, int column) {
  if (is_following_) return;
  const std::uint8_t tag = tag_of(*item);
  RegionLook look = document_.state().looks.at(tag);
  if (column == kSolo) {
    document_.set_solo(item->checkState(kSolo) == Qt::Checked ? std::optional(tag) : std::nullopt);
    return;
  }
  if (column != kName) return follow();  // what is told cannot be edited
  const bool is_visible = item->checkState(kName) == Qt::Checked;
  const QString what = is_visible == look.is_visible ? tr("Rename region") : tr("Show region");
  look.is_visible = is_visible;
  if (!item->text(kName).trimmed().isEmpty()) look.name = item->text(kName).trimmed();
  set_look(document_, tag, look, what);
  follow();
}

void RegionList::choose_colour() {
  RegionLook look = document_.state().looks.at(document_.selected_tag());
  const QColor chosen = QColorDialog::getColor(look.colour, this, tr("Colour of %1").arg(look.name));
  if (!chosen.isValid()) return;
  look.colour = chosen;
  set_look(document_, document_.selected_tag(), look, tr("Colour region"));
}

}  // namespace nutik::studio
