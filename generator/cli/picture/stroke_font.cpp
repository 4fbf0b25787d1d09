// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture/stroke_font.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace eomgen::cli {
namespace {

struct Glyph {
  std::string_view character;  // UTF-8
  // Strokes are separated by blanks. A point is two characters: x from 0 to 4; y from 0 to 6 above the baseline, or y
  // and z for 2 and 1 below it.
  std::string_view strokes;
};

constexpr Glyph glyphs[] = {{"0", "010516364541301001"},
                            {"1", "142620 1030"},
                            {"2", "05163645440040"},
                            {"3", "051636454433 2333 334241301001"},
                            {"4", "30360242"},
                            {"5", "46060314344341301001"},
                            {"6", "453616050110304142331302"},
                            {"7", "064610"},
                            {"8", "13040516364544331302011030414233"},
                            {"9", "011030414536160504133344"},
                            {"A", "002640 1232"},
                            {"B", "00063645443303 3342413000"},
                            {"C", "4536160501103041"},
                            {"D", "00062644422000"},
                            {"E", "46060040 0333"},
                            {"F", "460600 0333"},
                            {"G", "45361605011030414323"},
                            {"H", "0006 4046 0343"},
                            {"I", "1636 2620 1030"},
                            {"J", "3631201001"},
                            {"K", "0006 4602 1340"},
                            {"L", "060040"},
                            {"M", "0006234640"},
                            {"N", "00064046"},
                            {"O", "010516364541301001"},
                            {"P", "00063645443303"},
                            {"Q", "010516364541301001 2240"},
                            {"R", "00063645443303 2340"},
                            {"S", "453616050413334241301001"},
                            {"T", "0646 2620"},
                            {"U", "060110304146"},
                            {"V", "062046"},
                            {"W", "0610233046"},
                            {"X", "0046 0640"},
                            {"Y", "062346 2320"},
                            {"Z", "06460040"},
                            {"a", "0314243330 321201102031"},
                            {"b", "0006 0314243331201001"},
                            {"c", "3324140301102031"},
                            {"d", "3036 3324140301102031"},
                            {"e", "02323324140301102031"},
                            {"f", "36261510 0424"},
                            {"g", "343z2y1y0z 3324140301102031"},
                            {"h", "0006 0314243330"},
                            {"i", "1014 1616"},
                            {"j", "141z0y 1616"},
                            {"k", "0006 3401 1230"},
                            {"l", "1610"},
                            {"m", "0004 03142320 23344340"},
                            {"n", "0004 0314243330"},
                            {"o", "010314243331201001"},
                            {"p", "040y 0314243331201001"},
                            {"q", "343y 3324140301102031"},
                            {"r", "0004 031424"},
                            {"s", "33241403122231201001"},
                            {"t", "16112030 0434"},
                            {"u", "0401102031 3430"},
                            {"v", "042044"},
                            {"w", "0410233044"},
                            {"x", "0034 0430"},
                            {"y", "0420 441y"},
                            {"z", "04340030"},
                            {" ", ""},
                            {"\u00a0", ""},
                            {".", "0000"},
                            {",", "010z"},
                            {":", "0101 0404"},
                            {";", "010z 0404"},
                            {"-", "0232"},
                            {"\u2212", "0343"},
                            {"+", "0343 2521"},
                            {"=", "0242 0444"},
                            {"/", "0046"},
                            {"\\", "0640"},
                            {"(", "26151120"},
                            {")", "06151100"},
                            {"[", "26161020"},
                            {"]", "06161000"},
                            {"{", "261613031020"},
                            {"}", "061613231000"},
                            {"_", "0z4z"},
                            {"^", "142634"},
                            {"*", "2622 0543 4503"},
                            {"'", "1614"},
                            {"\"", "0604 2624"},
                            {"<", "450341"},
                            {">", "054301"},
                            {"|", "161y"},
                            {"!", "1612 1010"},
                            {"?", "051636454423 2322 2020"},
                            {"%", "0046 0606 4040"},
                            {"#", "1016 3036 0242 0444"},
                            {"\u00b7", "1313"},
                            {"\u00d7", "0145 0541"},
                            {"~", "03142334 3444"},
                            {"&", "403605 0516 1625 2501 0110 1042"},
                            {"$", "453616050413334241301001 2720"},
                            {"@", "3222122333 334333"},
                            {"`", "0615"}};

constexpr std::string_view box = "0006464000";
constexpr double advance = 1.7, along = 0.094, upwards = 0.118;  // a grid unit relative to the font size

double height(char c) { return c == 'z' ? -1 : c == 'y' ? -2 : c - '0'; }

std::string_view strokes_of(std::string_view character) {
  const auto* const found =
      std::find_if(std::begin(glyphs), std::end(glyphs), [&](const Glyph& g) { return g.character == character; });
  return found == std::end(glyphs) ? box : found->strokes;
}

}  // namespace

StrokedText stroke_text(const std::string& text, double size) {
  StrokedText result;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    while (i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xc0) == 0x80) ++length;
    const std::string_view strokes = strokes_of(std::string_view(text).substr(i, length));
    double widest = strokes.empty() ? 2 : 0;
    Stroke stroke;
    const auto close = [&] {
      if (!stroke.empty()) result.strokes.push_back(std::move(stroke));
      stroke.clear();
    };
    for (std::size_t k = 0; k + 1 < strokes.size();) {
      if (strokes[k] == ' ') {
        close();
        ++k;
        continue;
      }
      const double x = strokes[k] - '0', y = height(strokes[k + 1]);
      widest = std::max(widest, x);
      stroke.emplace_back(result.width + x * along * size, y * upwards * size);
      k += 2;
    }
    close();
    result.width += (widest + advance) * along * size;
    i += length;
  }
  result.width -= text.empty() ? 0 : advance * along * size;
  return result;
}

}  // namespace eomgen::cli
