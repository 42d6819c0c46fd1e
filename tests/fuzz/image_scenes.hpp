// Small worlds whose images hold something of everything: what the fuzzer of images forges.
#pragma once

#include <array>
#include <string_view>

namespace breve::fuzz {

inline constexpr std::array<std::string_view, 6> kImageScenes = {
    // Abstract agents: every kind of value, cycles, garbage, schedule, notifications, handlers, neighbours, a menu.
    R"(@use Control.
@use Mobile.
@use MenuItem.
Controller Town.
Object : Clerk (aka Clerks) {
  + variables:
    friend (object).
    papers (list).
    index (hash).
    turn (matrix).
    bytes (data).
    marks (3 ints).
  + to init:
    papers = { 1, 2.5, (1, 2, 3), "paper", { 4, { 5 } } }.
    index{"self"} = self.
    index{3} = papers.
    marks[1] = 7.
    self enable-auto-free.
  + to befriend with other (object): friend = other.
  + to hear from other (object) text t (string): push t onto papers.
  + to note: push "noted" onto papers.
}
Mobile : Walker (aka Walkers) {
  + to init:
    self move to random[(6, 6, 6)].
    self set-velocity to random[(2, 2, 2)] - (1, 1, 1).
    self set-neighborhood-size to 3.0.
    self handle-collisions with-type "Walker" with-method "bump".
    self set-color to (1, 0, 0).
    self set-label to "walker".
  + to bump: self set-velocity to (0, 1, 0).
}
Control : Town {
  + variables:
    staff (list).
    text (string).
  + to init:
    i (int).
    staff = 5 new Clerks.
    for i = 0, i < 5, i++: staff{i} befriend with staff{(i + 1) % 5}.
    6 new Walkers.
    staff{0} observe instance self for-notification "news" with-method "hear".
    staff{1} schedule method-call "note" at-time 3.0.
    self add-menu named "Again" for-method "again".
    self wrap-space from (-9, -9, -9) to (9, 9, 9).
  + to again: text = "".
  + to iterate:
    ring (list).
    self update-neighbors.
    super iterate.
    self announce message "news".
    text = "$text.".
    ring = { staff }.
    push ring onto ring.
    (new Clerk) befriend with (new Clerk).
    if |staff| > 3: staff = { staff{0}, staff{1}, staff{2} }.
})",
    // Bodies in space: an arm that a motor drives, closed loops, springs, contacts, terrain.
    R"(@use PhysicalControl.
@use MultiBody.
@use Link.
@use Joint.
@use Spring.
@use Mobile.
@use Stationary.
@use Terrain.
@use Shape.
Controller Yard.
PhysicalControl : Yard {
  + variables:
    a, b, c, hinge, ball, slider, body, tie, box (object).
  + to init:
    new Floor.
    (new Terrain) move to (40, 0, 0).
    a = new Link. b = new Link. c = new Link.
    a move to (0, 4, 0).
    hinge = new RevoluteJoint.
    hinge link with-normal (0, 0, 1) parent a to-child b with-parent-point (1, 0, 0) with-child-point (-1, 0, 0).
    hinge set-strength-limit to 30.0.
    hinge set-joint-velocity to 2.0.
    ball = new BallJoint.
    ball link parent b to-child c with-parent-point (1, 0, 0) with-child-point (-1, 0, 0).
    slider = new PrismaticJoint.
    slider link with-normal (0, 1, 0) parent 0 to-child a with-parent-point (0, 4, 0) with-child-point (0, 0, 0).
    body = new MultiBody.
    body set-root to a.
    box = new Mobile.
    box set-shape to (new Cube init-with size (1, 1, 1)).
    box move to (5, 0.6, 0).
    box enable-physics.
    (new Mobile) move to (5, 3, 0).
    tie = new Spring.
    tie connect from b to box with-length 2.0 with-strength 5.0 with-damping 0.5.
})",
    // Bodies that fall asleep: a stack that nothing moves.
    R"(@use PhysicalControl.
@use Mobile.
@use Stationary.
@use Shape.
Controller Shelf.
Mobile : Brick (aka Bricks) {
  + to init:
    self set-shape to (new Cube init-with size (1, 1, 1)).
    self enable-physics.
    self handle-collisions with-type "Brick" with-method "clack".
  + to clack: self set-color to (0, 0, 1).
}
PhysicalControl : Shelf {
  + variables:
    bricks (list).
  + to init:
    i (int).
    self enable-auto-disable.
    self set-iteration-step to 0.5.
    new Floor.
    bricks = 4 new Bricks.
    for i = 0, i < 4, i++: bricks{i} move to (0, 0.5 + i, 0).
})",
    // A flat world.
    R"(@use PlanarControl.
@use Link.
@use Joint.
@use Spring.
@use Mobile.
@use Stationary.
@use Shape.
Controller Table.
Mobile : Puck (aka Pucks) {
  + to init:
    self set-shape to (new Sphere init-with radius 0.5).
    self move to random[(8, 4, 0)] + (0, 1, 0).
    self enable-physics.
    self handle-collisions with-type "Puck" with-method "knock".
  + to knock: self set-color to (0, 1, 0).
}
PlanarControl : Table {
  + variables:
    a, b, hinge, slider, tie (object).
    pucks (list).
  + to init:
    self enable-auto-disable.
    new Floor.
    pucks = 6 new Pucks.
    a = new Link. b = new Link.
    hinge = new RevoluteJoint.
    hinge link with-normal (0, 0, 1) parent a to-child b with-parent-point (1, 0, 0) with-child-point (-1, 0, 0).
    hinge set-strength-limit to 30.0.
    hinge set-joint-velocity to 2.0.
    slider = new PrismaticJoint.
    slider link with-normal (0, 1, 0) parent 0 to-child a with-parent-point (-4, 4, 0) with-child-point (0, 0, 0).
    tie = new Spring.
    tie connect from b to pucks{0} with-length 2.0 with-strength 5.0 with-damping 0.5.
})",
    // Patches, matrices, a reaction, agents on cells, pictures, drawings.
    R"(@use Control.
@use PatchGrid.
@use GridAgent.
@use Reaction.
@use Matrix.
@use Image.
@use Drawing.
@use Camera.
Controller Dish.
Patch : Cell {
  + variables:
    n (int).
  + to init-patch: n = random[9].
  + to mix: self set-state to n.
}
GridAgent : Ant (aka Ants) {
  + to iterate: self move-to-free-neighbor.
}
Control : Dish {
  + variables:
    cells, board, salt, u, v, reaction, picture, pen (object).
  + to init:
    i (int).
    cells = ((new PatchToroid) init-with x-count 3 y-count 4 z-count 1 patch-class "Cell").
    board = ((new PatchGrid) init-with x-count 4 y-count 4 z-count 2).
    cells set-update-order to "random".
    board randomize-states with-density 0.4.
    board set-rule born { 5, 6 } survive { 4, 5, 6 }.
    salt = ((new PatchChemical) init-with diffusion-rate 0.1 decay-rate 0.01).
    board track patch-chemical salt.
    for i = 0, i < 5, i++: (new Ant) enter-free-cell of board.
    u = ((new Matrix2D) init-with x-size 4 y-size 4).
    v = ((new Matrix2D) init-with x-size 4 y-size 4).
    u set-value to 1.0 at-x 2 at-y 3.
    reaction = ((new Reaction) init-with fields { u, v }).
    reaction set-diffusion of u to 0.1.
    reaction add-term to v rate 0.3 powers { 1, 1 }.
    picture = new Image.
    picture set-size width 4 height 4.
    pen = new Drawing.
    pen draw-line from (0, 0, 0) to (1, 2, 3).
  + to iterate:
    super iterate.
    cells update-patches with-method "mix".
    board apply-rule.
    board update-concentrations.
    reaction step by 0.5.
    u copy-to-red-channel of-image picture with-scale 1.0.
})",
    // What learns, and what sounds: networks in training, searches between their questions, Push in the middle of a
    // run.
    R"(@use Control.
@use SFFNetwork.
@use CMAEvolutionStrategy.
@use MultiObjectiveSearch.
@use Push.
@use Sound.
@use Line.
@use Mobile.
Controller School.
Control : School {
  + variables:
    network, search, fronts, interpreter, program, pool, tone, line (object).
    questions, answers, values, pairs (list).
  + to count:
    interpreter push-integer value 3.
  + to init:
    i (int).
    network = new NeuralNetwork.
    network add-layer with-neuron-count 2.
    network add-elman-layer with-neuron-count 3.
    network add-continuous-time-layer with-neuron-count 1.
    network set-optimizer to "adam" with-learning-rate 0.1.
    questions = { { 0, 1 }, { 1, 0 } }.
    answers = { { 1 }, { 0 } }.
    search = new CMAEvolutionStrategy.
    search begin at { 0, 1, 2 } with-step 0.5 with-population 4.
    fronts = new MultiObjectiveSearch.
    fronts begin from { 0, 1 } to { 1, 2 } with-objectives 2 with-population 4.
    for i = 0, i < 4, i++: { push i onto values. push { i, 3 - i } onto pairs. }
    interpreter = new PushInterpreter.
    interpreter add-instruction for-instance self for-method "count" named "COUNT".
    program = new PushProgram.
    program parse program "( X INTEGER.DEFINE 1 1000000 EXEC.DO*RANGE ( INTEGER.DUP CODE.DUP COUNT [1 2 3] 0.5 TRUE ) ) ".
    interpreter add-macro named "TWICE" for-code program.
    pool = new PushDiversityPool.
    pool add program program.
    tone = new Tone.
    tone set-frequency to 440.0.
    line = ((new Line) connect from (new Mobile) to (new Mobile) with-color (1, 0, 0) with-style "- -").
    interpreter run program program for-steps 30.
    search ask.
    fronts ask.
  + to iterate:
    super iterate.
    network train with-inputs questions with-targets answers.
    network run-with inputs { 0.5, 1 }.
    search tell values values.
    search ask.
    fronts tell values pairs.
    fronts ask.
    interpreter step for-steps 20.
    program mutate with-interpreter interpreter.
    pool add program program.
    tone set-frequency to 440.0 + random[10.0].
})",
};

}  // namespace breve::fuzz
