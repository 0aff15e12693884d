// A quarter of a round plate, radius 0.5 m, for Gmsh: gmsh -2 plate.geo -format msh41
SetFactory("OpenCASCADE");
r = 0.5;
size = 0.042;
Point(1) = {0, 0, 0, size};
Point(2) = {r, 0, 0, size};
Point(3) = {0, r, 0, size};
Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Recombine Surface {1};
Physical Point("middle") = {1};
Physical Curve("edge_x") = {1};
Physical Curve("rim") = {2};
Physical Curve("edge_y") = {3};
Physical Surface("plate") = {1};
