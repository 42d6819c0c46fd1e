// The texts of the programs whose allocations are failed.
#include "programs.hpp"

#include <array>
#include <cstring>
#include <string_view>

namespace limits {

namespace {

struct Module {
  const char* name;
  std::string_view text;
};

constexpr std::string_view kMain = R"tz(
@use Helper.
@include "words.tz".
@path "data".
@define PLACES 4.
@use GridAgent.
@use Reaction.
Controller Everything.

Patch : Ground {
	+ to grow:
		self set-state to (self get-state) + |(self get-moore-neighborhood)|.
}

Control : Everything (aka Everythings) {
	+ variables:
		turns, heard, rung, repeated, bumps, pressed, chosen, clicks (int).
		kept, words, cells (list).
		table (hash).
		title (string).
		picture, plane, diffused, cube, row, note, spinner, tree, camera, entry, drawing, board, ant (object).
		bag (data).
		frame (matrix).
		grid (4 objects).

	+ to init:
		self set-iteration-step to 0.1.
		self set-integration-step to 0.05.
		entry = (self add-menu named "Choose this entry of the menu" for-method "choose-entry").
		self add-menu-separator.
		PLACES new Walkers.
		(new Post) move to (2.2, 0, 0).
		new Floor.
		note = new Note.
		self make-pictures.
		self make-shapes.
		self observe instance self for-notification "a-turn-has-come" with-method "hear-a-turn".
		note observe instance self for-notification "a-turn-has-come" with-method "hear-a-turn".
		self schedule method-call "ring-once-and-again" at-time 0.25.
		self schedule-repeating method-call "ring-repeatedly" with-interval 0.1.
		self set-display-text to "some text that is longer than a small string" at-x 0.1 number 2.
		self point-camera at (0, 0, 0) from (0, 0, 40).
		self watch item note.
		camera = new Camera.
		camera watch item (new Post).
		self wrap-space from (-1000, 0, 0) to (1000, 0, 0).
		board = ((new PatchToroid) init-with x-count 3 y-count 2 z-count 1 patch-class "Ground").
		board track patch-chemical ((new PatchChemical) init-with diffusion-rate 0.1 decay-rate 0.1).
		ant = new GridAgent.

	+ to make-pictures:
		picture = ((new Image) init-with width 8 height 6).
		picture set-pixel to (1, 0, 1) at-x 3 at-y 2.
		plane = ((new Matrix2D) init-with x-size 5 y-size 5).
		diffused = ((new Matrix2D) init-with x-size 5 y-size 5).
		cube = ((new Matrix3D) init-with x-size 3 y-size 4 z-size 2).
		row = ((new Vector) init-with size 5).
		plane set-value to 1 at-x 2 at-y 2.
		plane set-value to 0.5 at-x 3 at-y 2.

	+ to make-shapes:
		s, t (object).

		s = new CustomShape.
		s add-face with-vertex-list { (1, 1, 1), (-1, -1, 1), (-1, 1, -1) }.
		s add-face with-vertex-list { (1, 1, 1), (1, -1, -1), (-1, -1, 1) }.
		s add-face with-vertex-list { (1, 1, 1), (-1, 1, -1), (1, -1, -1) }.
		s add-face with-vertex-list { (-1, -1, 1), (1, -1, -1), (-1, 1, -1) }.
		s finish-shape with-density 3.
		t = new Mobile.
		t set-shape to s.
		t move to (0, 30, 0).
		(new Stationary) register with-shape ((new Cube) init-with size (1, 2, 3)) at-location (9, 9, 9).
		(new Mobile) set-shape to ((new PolygonDisk) init-with sides 5 height 1 radius 2).
		(new Mobile) set-shape to ((new PolygonCone) init-with sides 6 height 1 radius 2).
		drawing = new TurtleDrawing.
		drawing forward by 2. drawing turn-right by 30. drawing push-state. drawing forward by 1. drawing pop-state.
		t add-line to (new Mobile) with-color (1, 0, 0) with-style "--- - ".

	+ to choose-entry:
		chosen += 1.
	+ to catch-key-a-down:
		pressed += 1.
	+ to click on what (object):
		clicks += 1.
	+ to hear-a-turn from source (object) message m (string):
		heard += |m|.
	+ to ring-once-and-again:
		rung += 1.
		self schedule method-call "ring-once-and-again" at-time ((self get-time) + 0.15).
	+ to ring-repeatedly:
		repeated += 1.

	+ to iterate:
		turns += 1.
		self work-with-lists.
		self work-with-text.
		self work-with-hashes.
		self work-with-grids.
		self work-with-cells.
		self make-garbage.
		if turns == 1: self work-with-files.
		if turns == 2: self work-with-archives.
		if turns == 3: self look-around.
		self announce message "a-turn-has-come".
		self update-neighbors.
		super iterate.

	+ to work-with-lists:
		i (int).
		k, m (list).

		for i = 0, i < 9, i++: push (i * 7919) % 31 onto k.
		sort k with by-value.
		prepend -1 onto k. insert 5 at k{4}. remove k{2}. pop k. unprepend k.
		push { 1, { 2, "three" } } onto k.
		m = copylist k.
		push m onto kept.
		if |kept| > 3: unprepend kept.
		cells = all Walkers.
		cells count-a-step.

	+ to by-value this a (int) with b (int):
		return a - b.

	+ to work-with-text:
		s (string).
		i (int).

		for i = 0, i < 2, i++: s = s + "turn $turns of ${title}, word $i. ".
		s{0} = "T".
		title = "the title of turn $turns".
		words = { "some", "words" }.
		push s onto words.
		push { "$self", "$kept", "$frame" } onto words.
		print "turn", turns, (1, 2, 3), kept, table, self, note.
		printf "no line end".

	+ to work-with-hashes:
		i (int).

		for i = 0, i < 5, i++: {
			table{i + turns} = "value number $i".
			table{"key number $i"} = { i, turns }.
		}
		table{(1, 2, i)} = keys(table).
		remove table{turns}.
		frame = [(1, 0, 0), (0, 2, 0), (0, turns, 3)].
		frame = transpose(frame * frame) + frame.
		table::frame = frame.

	+ to work-with-grids:
		diffused compute-diffusion-matrix from plane.
		plane add-values of diffused scaled-by 0.1.
		plane transform with-matrix plane with-result diffused.
		diffused = ((new Matrix2D) init-with x-size 5 y-size 5).
		cube compute-periodic-diffusion-matrix from cube.
		plane copy-to-red-channel of-image picture.
		row set-size to turns + 3.
		picture set-size width (turns + 4) height 6.

	+ to work-with-cells:
		reaction, other (object).

		board set-rule born { 3 } survive { 2, 3 }.
		board apply-rule.
		board set-update-order to "random".
		board apply-rule.
		board update-patches with-method "grow".
		board update-concentrations.
		board display-concentration-in-red of-patch-chemical ((board get-patch-chemicals){0}).
		board set-patch-colors-to-chemical-concentrations.
		ant enter-free-cell of board.
		ant get-agents within 1.
		reaction = ((new Reaction) init-with fields { plane, diffused }).
		reaction add-term to plane rate -0.1 powers { 1, 1 }.
		reaction step by 0.1.
		free reaction.
		other = ((new PatchGrid) init-with x-count 2 y-count 2 z-count 2).
		(other get-patch-at x 0 y 0 z 0) set-color to (1, 0, 0).
		free other.

	+ to make-garbage:
		a, b (object).
		k (list).
		h (hash).

		a = new Spark. b = new Spark.
		a tie to b. b tie to a.
		push k onto k.
		h{"self"} = h.
		push h onto k.
		grid[turns % 4] = new Spark.
		(new Spark) say-nothing.
		free (new Plain).
		k = 3 new Plains.
		free k.
		self call-method named "by-value" with-arguments { 1, 2 }.
		self call-method named "no-such-method".
		new Complainer.

	+ to work-with-files:
		f (object).

		f = new File.
		f open-for-writing with-file "limits_made.txt".
		f write text "one two three". f write-line text "  four, five". f write text "last". f close.
		f open-for-reading with-file "limits_made.txt".
		words = (f read-line-as-whitespace-delimited-list).
		push (f read-line) onto words. f close.
		f open-for-reading with-file "limits_made.txt".
		bag = (f read-as-data). f close.
		picture write to "limits_made.png".
		picture load from "limits_made.png".
		title = findFile("limits_made.txt").

	+ to work-with-archives:
		copy (object).

		tree = new Note.
		tree::words = { 1, "two", { 3.5, (1, 2, 3) } }.
		tree archive-as-xml file "limits_made.xml".
		copy = (self dearchive-xml file "limits_made.xml").
		push (copy archive-as-xml-string) onto words.
		if copy: free copy.
		note save-to file "limits_note.xml".
		note load-from file "limits_note.xml".

	+ to look-around:
		w (object).

		foreach w in cells: push (w get-neighbors) onto kept.
		self set-background-texture-image to picture.
		w set-texture-image to picture.
		self pan-camera-offset by (1, 0, 0) steps 4.
		title = (self get-type) + (self get-description).
}
)tz";

constexpr std::string_view kHelper = R"tz(
@use Control.
@use Mobile.
Mobile : Walker (aka Walkers) {
	+ variables:
		steps, touched (int).
		seen (list).
	+ to init:
		self move to random[(4, 4, 4)].
		self set-velocity to random[(2, 2, 2)] - (1, 1, 1).
		self set-neighborhood-size to 3.
		self handle-collisions with-type "Post" with-method "touch-a-post".
		self handle-collisions with-type "Walker" with-method "touch-a-walker".
	+ to count-a-step:
		steps += 1.
	+ to touch-a-post with other (object) at place (vector):
		touched += 1.
		push "touched a post $touched times" onto seen.
		return 0.
	+ to touch-a-walker with other (object):
		touched += 1.
	+ to iterate:
		seen = (self get-neighbors).
		self set-rotational-velocity to (0, 1, 0).
}
Stationary : Post (aka Posts) { }
)tz";

constexpr std::string_view kWords = R"tz(
Object : Spark (aka Sparks) {
	+ variables:
		other (object).
		things (list).
	+ to init:
		self enable-auto-free.
		push "a spark" onto things.
	+ to tie to o (object):
		other = o.
		push o onto things.
	+ to say-nothing:
		return 0.
	+ to destroy:
		things = { "gone" }.
}
Object : Plain (aka Plains) {
	+ variables:
		text (string).
	+ to init:
		text = "plain " + "text".
}
Object : Complainer {
	+ to init:
		self enable-auto-free.
	+ to destroy:
		die "on purpose".
}
Data : Note (aka Notes) {
	+ variables:
		words (list).
		number (int).
	+ to hear-a-turn:
		number += 1.
	+ to give text t (string) twice n = 2 (int):
		push t onto words.
		return { t, n }.
}
)tz";

constexpr std::string_view kGrammar = R"tz(
@use Words.
@define LIMIT 3.
@define GREETING "a greeting that is longer than a small string".
@define CORNER (1, 2, 3).
Controller Grammar.

% What every kind of class is made of.
Object : Grammar (aka Grammars) [version 2.5] {
	% What an instance keeps.
	+ variables:
		count, never-used (int).
		weight (float).
		place (vector).
		turn (matrix).
		name (string).
		things (list).
		table (hash).
		friend (Word object).
		whoever (object).
		bytes (data).
		handle (pointer).
		levels (4 ints).
		spots (2 vectors).
		crew (3 Grammar objects).

	% Everything that may stand in a method.
	+ to init:
		i, unused (int).
		e (object).
		k (list).

		count = LIMIT + 2 * (7 - 3) / 2 % 5 - -1.
		weight = 1.5 ^ 2.0 + 0.25.
		place = CORNER * 2.0 - (0, 1, 0) / 4.0.
		place::y = place::x.
		turn = [(1, 0, 0), (0, 1, 0), (0, 0, 1)] * 2.0.
		name = GREETING.
		name = "$name and ${count}th, $levels[1] of $things{0}".
		k = { 1, "two", { 3.5, (1, 2, 3) } }.
		table{"one"} = 1.
		table::one = 2. table{"three"} = k{0}. k{0}++. levels[i + 1] -= 2. spots[1] *= 3.0.
		for i = 0, i < LIMIT, i++: { push i onto things. prepend i onto things. }
		insert 5 at things{1}. remove things{0}. pop things. unprepend things.
		sort things with in-order.
		k = copylist things.
		while |k| > 1 && !(i == 9 || i != i): pop k.
		friend = (new Word say t "a" to 2).
		foreach e in all Words: { e say t "nothing". if e: whoever = e. else if count >= 3: whoever = 0. else count--. }
		crew[0] = self. friend = whoever. 2 new Words.
		print "some text", count, weight, place. printf name, -weight, |k|.
		name = friend join first "x" with-last name.
		self fly-away at 3. super get-type.
		free friend. free all Words.
		if count > 100: die "of $count".

	+ to in-order this a (int) with b (int):
		return (a > b) - (a < b).
	- to unused-keyword with n = 3 (int) and-text t = "text" (string) and-place v = (1, 2, 3) (vector):
		return random[n] + sqrt(2.0) + n.
	= to never-returns: return.
}
)tz";

constexpr std::string_view kWord = R"tz(
Object : Word (aka Words) {
	+ variables: text (string).
	+ to say t t (string) to n = 1 (int): text = t. return self.
	+ to join first a (string) with-last b (string): return a + b.
	+ to destroy: text = "gone".
}
)tz";

constexpr std::string_view kLittle = R"tz(
Controller Little.
Object : Little {
	+ variables: turns (int).
	+ to iterate: turns++. print "turn $turns".
}
)tz";

constexpr std::array<Module, 6> kModules{{{"everything.tz", kMain},
                                          {"Helper.tz", kHelper},
                                          {"words.tz", kWords},
                                          {"grammar.tz", kGrammar},
                                          {"Words.tz", kWord},
                                          {"little.tz", kLittle}}};

}  // namespace

bool resolve_program(void*, const char* name, const char*, breve_module* module) {
  for (const Module& m : kModules) {
    if (std::strcmp(m.name, name) != 0) continue;
    module->text = m.text.data();
    module->size = m.text.size();
    return true;
  }
  return false;
}

}  // namespace limits
