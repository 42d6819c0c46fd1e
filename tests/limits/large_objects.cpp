#include "large_objects.hpp"

namespace breve::limits {

namespace {

constexpr Large kLarge[] = {
    // Pictures, matrices, vectors: square, and as one row or one column.
    {"Image", "@ = (new Image init-with width 3800 height 3800)."},
    {"Image", "@ = (new Image init-with width 30000 height 400)."},
    {"Image", "@ = (new Image init-with width 3 height 30000)."},
    {"MatrixImage", "@ = (new MatrixImage init-with the-matrix field scale 1.0)."},
    {"VectorImage", "@ = (new VectorImage init-with the-vector numbers scale 1.0)."},
    {"Matrix2D", "@ = (new Matrix2D init-with x-size 2500 y-size 2500)."},
    {"Matrix2D", "@ = (new Matrix2D init-with x-size 1 y-size 6000000)."},
    {"Matrix2D", "@ = (new Matrix2D init-with x-size 6000000 y-size 1)."},
    {"Matrix2D", "@ = (new Matrix2D init-with x-size 250 y-size 250)."},
    {"Matrix3D", "@ = (new Matrix3D init-with x-size 180 y-size 180 z-size 180)."},
    {"Matrix3D", "@ = (new Matrix3D init-with x-size 1 y-size 1 z-size 6000000)."},
    {"Matrix3D", "@ = (new Matrix3D init-with x-size 6000000 y-size 1 z-size 1)."},
    {"Vector", "@ = (new Vector init-with size 6000000)."},
    {"Vector", "@ = (new Vector init-with size 1000)."},
    // Grids: of many cells, in a plane, of one column, with many chemicals, full of agents.
    {"PatchGrid", "@ = (new PatchGrid init-with x-count 100 y-count 100 z-count 8)."},
    {"PatchGrid", "@ = (new PatchGrid init-with x-count 1 y-count 1 z-count 80000)."},
    {"PatchGrid", "@ = (new PatchGrid init-with x-count 250 y-count 250 z-count 1)."},
    {"PatchGrid",
     "@ = (new PatchGrid init-with x-count 30 y-count 30 z-count 1). for i = 0, i < 1000, i++: { chemical = (new "
     "PatchChemical init-with diffusion-rate 0.1 decay-rate 0.1). @ track patch-chemical chemical. }"},
    {"PatchGrid",
     "@ = (new PatchGrid init-with x-count 30 y-count 30 z-count 1). @ set-capacity to 10000. "
     "for i = 0, i < 8000, i++: (new GridAgent) enter-grid grid @ at-x 1 at-y 1."},
    {"PatchToroid",
     "@ = (new PatchToroid init-with x-count 100 y-count 100 z-count 8). @ track patch-chemical chemical."},
    {"Patch", "@ = (grid get-patch-at x 1 y 1 z 0)."},
    {"GridAgent",
     "grid set-capacity to 5000. for i = 0, i < 4000, i++: (new GridAgent) enter-grid grid grid at-x 1 at-y 1. "
     "@ = new GridAgent. @ enter-grid grid grid at-x 1 at-y 1."},
    {"Reaction", "@ = new Reaction. @ init-with fields { field }.", "push field onto fitting."},
    // Shapes: of many sides, of many corners, of large files; and one that a ball is.
    {"Shape", "@ = (new Sphere init-with radius 1.0)."},
    {"Sphere", "@ = (new Sphere init-with radius 1.0)."},
    {"PolygonDisk", "@ = (new PolygonDisk init-with sides 1000 height 1.0 radius 1.0)."},
    {"PolygonCone", "@ = (new PolygonCone init-with sides 1000 height 1.0 radius 1.0)."},
    {"MeshShape", "@ = new MeshShape. @ load-from-obj file \"mesh.obj\".", "", "\"mesh.obj\""},
    {"MeshShape", "@ = new MeshShape. @ load-hull file \"mesh.obj\".", "", "\"mesh.obj\""},
    {"CustomShape", "@ = new CustomShape. self make-faces of @. @ finish-shape with-density 1.0.",
     "fitting = { (0, 0, 0), (0, 1, 0), (1, 0, 0) }."},
    {"CustomShape", "@ = new CustomShape. self make-faces of @.", "fitting = { (0, 0, 0), (0, 1, 0), (1, 0, 0) }."},
    // Ground: square, fine and with bodies on it.
    {"Terrain", "@ = new Terrain. for i = 0, i < 5, i++: @ generate."},
    {"Terrain",
     "@ = new Terrain. for i = 0, i < 6, i++: @ generate. for i = 0, i < 300, i++: (things{i}) set-shape to shape."},
    // Networks of neurons: wide and deep.
    {"NeuralNetwork",
     "@ = new NeuralNetwork. @ add-layer with-neuron-count 500. @ add-elman-layer with-neuron-count 500.",
     "row = {}. for i = 0, i < 500, i++: push 0.5 onto row. for i = 0, i < 20, i++: push row onto fitting."},
    {"NeuralNetwork", "@ = new NeuralNetwork. for i = 0, i < 3000, i++: @ add-layer with-neuron-count 2.",
     "for i = 0, i < 20000, i++: push { 0.5, 0.5 } onto fitting."},
    {"NeuralNetwork",
     "@ = new NeuralNetwork. @ add-layer with-neuron-count 300. "
     "@ add-continuous-time-layer with-neuron-count 300 with-time-constant 1.0.",
     "for i = 0, i < 300, i++: push 0.5 onto fitting."},
    {"FFNetwork", "@ = new FFNetwork. @ add-layer with-neuron-count 500. @ add-layer with-neuron-count 500.",
     "row = {}. for i = 0, i < 500, i++: push 0.5 onto row. for i = 0, i < 20, i++: push row onto fitting."},
    // Evolution: many dimensions, large populations, large graphs and programs.
    {"CMAEvolutionStrategy",
     "row = {}. for i = 0, i < 150, i++: push 0.5 onto row. @ = new CMAEvolutionStrategy. "
     "@ begin at row with-step 1.0 with-population 40. @ ask.",
     "for i = 0, i < 40, i++: push 1.0 * i onto fitting."},
    {"CMAEvolutionStrategy",
     "row = { 0.5, 0.5 }. @ = new CMAEvolutionStrategy. @ begin at row with-step 1.0 with-population 20000. @ ask.",
     "for i = 0, i < 20000, i++: push 1.0 * i onto fitting."},
    {"MultiObjectiveSearch",
     "row = {}. other = {}. for i = 0, i < 50, i++: { push 0 onto row. push 1 onto other. } "
     "@ = new MultiObjectiveSearch. @ begin from row to other with-objectives 2 with-population 200. @ ask.",
     "for i = 0, i < 200, i++: push { i, 200 - i } onto fitting."},
    {"MultiObjectiveSearch",
     "row = { 0 }. other = { 1 }. @ = new MultiObjectiveSearch. "
     "@ begin from row to other with-objectives 20 with-population 2000. @ ask.",
     "for i = 0, i < 2000, i++: push { i, 0, i, 1, i, 2, i, 3, i, 4, i, 5, i, 6, i, 7, i, 8, i, 9 } onto fitting."},
    {"GeneticAlgorithm",
     "@ = new GeneticAlgorithm. @ set-individual-class to \"Solution\". @ set-population-size to 2000. "
     "@ generate-population."},
    {"RealVectorIndividual", "@ = new Solution. @ set-genome of-length 100000 from 0.0 to 1.0."},
    {"GADirectedGraph",
     "@ = new GADirectedGraph. @ randomize with-max-nodes 60 with-node-parameters 20 with-connection-parameters 20."},
    {"GADirectedGraph",
     "@ = new GADirectedGraph. @ randomize with-max-nodes 2000 with-node-parameters 1 with-connection-parameters 1 "
     "with-connection-probability 0.001."},
    {"GADirectedGraphNode",
     "@ = new GADirectedGraphNode. before = @. for i = 0, i < 2000, i++: { link = new GADirectedGraphNode. "
     "before connect to link with-parameters { 1, 2 }. before = link. }"},
    {"PushProgram",
     "interpreter set-list-limit to 100000. @ = new PushProgram. "
     "@ make-random-code with-interpreter interpreter max-length 50000.",
     "for i = 0, i < 1000, i++: push i onto fitting.", "\"( 1 ( 2 INTEGER.+ ) )\""},
    {"PushProgram",
     "text = \"1\". for i = 0, i < 3000, i++: text = \"( 1 $text )\". @ = new PushProgram. @ parse program text.",
     "for i = 0, i < 1000, i++: push i onto fitting.", "\"( 1 ( 2 INTEGER.+ ) )\""},
    {"PushInterpreter",
     "program parse program \"( 1 1000000 EXEC.DO*RANGE ( INTEGER.DUP CODE.DUP ) )\". "
     "@ = new PushInterpreter. @ set-list-limit to 100000. @ set-evaluation-limit to 1000000. "
     "for i = 0, i < 20000, i++: { @ push-integer value i. @ push-float value i. @ push-code value program. "
     "@ push-vector value (1, 2, 3). @ push-boolean value 1. @ push-exec value program. }",
     "", "\"instruction INTEGER.+\""},
    {"PushGP", "@ = new Symbols. @ set-population-size to 1000. @ create-population."},
    {"PushGPIndividual", "@ = new PushGPIndividual. @ make-random-code with-interpreter interpreter max-length 20000."},
    {"PushDiversityPool",
     "@ = new PushDiversityPool. for i = 0, i < 3000, i++: { program = new PushProgram. "
     "program make-random-code with-interpreter interpreter max-length 20. @ add program program. }"},
    // Pictures that programs draw.
    {"Drawing", "@ = new Drawing. for i = 0, i < 60000, i++: @ draw-line from (0, 0, 0) to (1, i, 1)."},
    {"Drawing",
     "@ = new Drawing. @ set-line-style to \"-- -\". for i = 0, i < 60000, i++: @ add-polygon-point at (i % 7, i, 1)."},
    {"TurtleDrawing",
     "@ = new TurtleDrawing. for i = 0, i < 20000, i++: { @ forward by 1. @ push-state. @ turn-left by 3. }"},
    {"Tracer", "@ = new Tracer. @ trace agent body."},
    {"Graph",
     "@ = new Graph. @ add-line with-color (1, 0, 0). for i = 0, i < 50000, i++: @ add-point on-line 0 with-value i."},
    {"Graph",
     "@ = new Graph. @ set-title to long. @ set-x-axis-name to long. for i = 0, i < 3000, i++: { "
     "@ add-line with-color (1, 0, 0). @ add-point on-line i with-value i. }"},
    {"MenuItem",
     "for i = 0, i < 5000, i++: self add-menu named \"$i\" for-method \"settle\". "
     "@ = (body add-menu named \"one\" for-method \"settle\")."},
    {"Movie", "@ = new Movie. @ record to \"film.y4m\"."},
    // Bodies: of large shapes, in a crowd, with many joints, springs, sensors, lines and menus.
    {"Real", "@ = new Mobile. @ set-shape to shape."},
    {"Mobile",
     "@ = new Mobile. @ set-shape to (new Sphere init-with radius 1.0). @ enable-physics. @ set-label to long."},
    {"Mobile",
     "link = new MeshShape. link load-from-obj file \"mesh.obj\". @ = new Mobile. @ set-shape to link. "
     "@ set-texture-image to picture. @ set-display-shape to link. for i = 0, i < 3, i++: (things{i}) set-shape to "
     "link."},
    {"Mobile",
     "link = new CustomShape. self make-faces of link. link finish-shape with-density 1.0. @ = new Mobile. "
     "@ set-shape to link. @ enable-physics."},
    {"Mobile",
     "@ = new Mobile. @ set-neighborhood-size to 1000.0. foreach link in things: { link set-shape to shape. "
     "link set-neighborhood-size to 100.0. } self update-neighbors."},
    {"Mobile",
     "@ = new Mobile. @ enable-physics. foreach link in things: { before = new Spring. "
     "before connect from @ to link with-length 1.0 with-strength 1.0 with-damping 1.0. }"},
    {"Mobile",
     "@ = new Mobile. for i = 0, i < 5000, i++: { @ add-line to (things{i % 3000}). @ add-menu named \"$i\" for-method "
     "\"settle\". @ schedule method-call \"settle\" at-time 1000.0 + i. @ observe instance body for-notification "
     "\"$i\" "
     "with-method \"settle\". }"},
    {"Stationary", "@ = new Stationary. @ register with-shape shape at-location (0, 0, 0)."},
    {"MultiBody",
     "@ = new MultiBody. link = new Link. @ register with-link link. for i = 0, i < 60, i++: { before = link. "
     "link = new Link. joint = new RevoluteJoint. joint link parent before to-child link with-normal (0, 0, 1) "
     "with-parent-point (0.5, 0, 0) with-child-point (-0.5, 0, 0). }"},
    {"MultiBody",
     "@ = new MultiBody. before = new Link. @ register with-link before. for i = 0, i < 300, i++: { link = new Link. "
     "joint = new BallJoint. joint link parent before to-child link with-parent-point (0.5, 0, 0) "
     "with-child-point (-0.5, 0, 0). }"},
    {"Link",
     "@ = new Link. (new MultiBody) register with-link @. for i = 0, i < 200, i++: { link = new Link. "
     "joint = new RevoluteJoint. joint link parent @ to-child link with-normal (0, 0, 1). }"},
    {"RevoluteJoint",
     "link = new Link. before = new Link. @ = new RevoluteJoint. @ link parent before to-child link with-normal (0, 0, "
     "1)."},
    {"PrismaticJoint",
     "link = new Link. before = new Link. @ = new PrismaticJoint. @ link parent before to-child link with-normal (0, "
     "0, 1)."},
    {"BallJoint", "link = new Link. before = new Link. @ = new BallJoint. @ link parent before to-child link."},
    {"UniversalJoint",
     "link = new Link. before = new Link. @ = new UniversalJoint. @ link parent before to-child link with-normal (0, "
     "0, 1)."},
    {"FixedJoint", "link = new Link. before = new Link. @ = new FixedJoint. @ link parent before to-child link."},
    {"RevoluteJoint",
     "link = new Link. (new MultiBody) register with-link link. for i = 0, i < 200, i++: { before = link. "
     "link = new Link. @ = new RevoluteJoint. @ link parent before to-child link with-normal (0, 0, 1). }"},
    {"Joint",
     "link = new Link. (new MultiBody) register with-link link. for i = 0, i < 100, i++: { before = link. "
     "link = new Link. @ = new BallJoint. @ link parent before to-child link. }"},
    {"Spring",
     "link = new Mobile. before = new Mobile. @ = new Spring. @ connect from link to before with-length 1.0 "
     "with-strength 1.0 with-damping 1.0."},
    {"Spring",
     "@ = new Spring. @ connect from body to (new Mobile). foreach link in things: { before = new Spring. "
     "before connect from body to link. }"},
    {"Line", "@ = new Line. @ connect from body to (new Mobile)."},
    {"BraitenbergVehicle",
     "@ = new BraitenbergVehicle. for i = 0, i < 15, i++: { link = (@ add-wheel at (i, 0, 1)). before = (@ add-sensor "
     "at "
     "(i, 1, 0)). before link to link. } for i = 0, i < 300, i++: new BraitenbergLight."},
    {"BraitenbergHeavyVehicle", "@ = new BraitenbergHeavyVehicle."},
    {"BraitenbergWheel", "@ = (new BraitenbergVehicle add-wheel at (1, 0, 1))."},
    {"BraitenbergSensor",
     "for i = 0, i < 300, i++: new BraitenbergLight. @ = (new BraitenbergVehicle add-sensor at (1, 0, 1))."},
    {"IRSensorKind",
     "for i = 0, i < 1000, i++: { push i onto row. push 0.5 onto other. } "
     "@ = new IRSensorKind. @ set-up with-name \"large\" with-rows 1000 with-columns 1000 with-range 10.0 with-angle "
     "0.5 "
     "with-distances { |row|, row, other } with-azimuths { |row|, row, other } with-incidences { |row|, row, other }.",
     "fitting = { |row|, row, other }."},
    {"IRSensor",
     "createUserSensor(\"eye\", 30, 30, 10.0, 0.5, 1, { 1.0 }, { 1.0 }, 1, { 1.0 }, { 1.0 }, 1, { 1.0 }, { 1.0 }). "
     "body set-neighborhood-size to 1000.0. foreach link in things: link set-shape to shape. self update-neighbors. "
     "@ = new IRSensor. @ init-with type \"eye\" rel-position (1, 0, 0) rel-rotation [ (1, 0, 0), (0, 1, 0), (0, 0, 1) "
     "] "
     "owner body.",
     "", "\"eye\""},
    // Files, sounds, archives.
    {"File", "@ = new File. @ open-for-reading with-file \"lines.txt\".", "", "\"lines.txt\""},
    {"File", "@ = new File. @ open-for-writing with-file \"lines.out\"."},
    {"Sound", "@ = new Sound. @ load from-file \"sound.wav\".", "", "\"sound.wav\""},
    {"Data", "@ = new Kept. @ keep value many. @ save-to file \"data.tz\". @ save-as-xml file \"data.xml\"."},
    {"Data", "@ = new Kept. @ keep value tree."},
    {"Object", "@ = new Kept. @ keep value deep."},
    {"Object",
     "@ = body. for i = 0, i < 10000, i++: { body schedule method-call \"settle\" at-time 1000.0 + i. "
     "body observe instance @ for-notification \"$i\" with-method \"settle\". }"},
    {"Camera", "for i = 0, i < 100, i++: new Camera. @ = new Camera."},
    {"QProgram", "@ = new QProgram. for i = 0, i < 20000, i++: @ add-instruction with-string \"HADAMARD $i\"."},
    // Worlds: crowded, full of springs, of lines, over large ground, beside a large mesh.
    {"Control",
     "@ = self. self save-as-xml file \"data.xml\". foreach link in things: { link set-shape to shape. "
     "link set-neighborhood-size to 100.0. link handle-collisions with-type \"Mobile\" with-method \"settle\". }"},
    {"Control",
     "@ = self. for i = 0, i < 300, i++: { (things{i}) set-shape to shape. (things{i}) move to random[(9, 9, 9)]. "
     "(things{i}) enable-physics. }"},
    {"Control",
     "@ = self. for i = 0, i < 20000, i++: { link = new Line. link connect from body to (things{i % 3000}). } "
     "for i = 0, i < 500, i++: self set-display-text to long number i."},
    {"Control", "@ = self. link = new Terrain. for i = 0, i < 5, i++: link generate. link draw-wireframe."},
    {"Control",
     "@ = self. link = new MeshShape. link load-from-obj file \"mesh.obj\". for i = 0, i < 100, i++: { "
     "(things{i}) set-shape to link. (things{i}) move to random[(9, 9, 9)]. } shape = link."},
    {"Control",
     "@ = self. link = new CustomShape. self make-faces of link. link finish-shape with-density 1.0. "
     "for i = 0, i < 30, i++: { (things{i}) set-shape to link. (things{i}) move to random[(1, 1, 1)]. "
     "(things{i}) enable-physics. } shape = link."},
    {"Control",
     "@ = self. for i = 0, i < 2999, i++: { link = new Spring. link connect from (things{i}) to (things{i + 1}). } "
     "for i = 0, i < 100, i++: (things{i}) enable-physics."},
    {"Control",
     "@ = self. for i = 0, i < 300, i++: { (things{i}) set-shape to shape. (things{i}) set-label to \"a long name "
     "$i\". "
     "(things{i}) set-texture-image to picture. (things{i}) set-transparency to 0.5. (things{i}) show-axis. "
     "(things{i}) show-neighbor-lines. } self enable-lighting. self enable-shadows."},
};

}  // namespace

std::vector<Large> ways_to_be_large(std::string_view cls) {
  std::vector<Large> ways;
  for (const Large& known : kLarge)
    if (known.cls == cls) ways.push_back(known);
  return ways;
}

std::string_view derived_classes() {
  return R"(RealVectorIndividual : Solution {
  + to init: self set-genome of-length 20 from 0.0 to 1.0.
}
PushGP : Symbols {
  + to count-fitness-cases: return 3.
  + to setup-fitness-test for-fitness-case n (int) with-interpreter machine (object): machine push-integer value n.
  + to compute-error for-fitness-case n (int) with-interpreter machine (object): return n.
}
Data : Kept {
  + variables:
    kept (list).
  + to keep value newValue (list): kept = newValue.
}
)";
}

}  // namespace breve::limits
