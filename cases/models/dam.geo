// A dam on rock: two surfaces that share the curve between them. `gmsh -2 dam.geo -format msh41 -o dam.msh`
h = 3;
Point(1) = { -25, -15, 0, 6 };  Point(2) = { 30, -15, 0, 6 };
Point(3) = { 30, 0, 0, 6 };     Point(4) = { -25, 0, 0, 6 };
Point(5) = { 0, 0, 0, h };        Point(6) = { 12, 0, 0, h };
Point(7) = { 3, 16, 0, h };       Point(8) = { 0, 16, 0, h };
Line(1) = { 1, 2 };  Line(2) = { 2, 3 };  Line(3) = { 3, 6 };  Line(4) = { 6, 5 };
Line(5) = { 5, 4 };  Line(6) = { 4, 1 };  Line(7) = { 6, 7 };  Line(8) = { 7, 8 };  Line(9) = { 8, 5 };
Curve Loop(1) = { 1, 2, 3, 4, 5, 6 };
Curve Loop(2) = { -4, 7, 8, 9 };
Plane Surface(1) = { 1 };
Plane Surface(2) = { 2 };
Recombine Surface { 2 };
Physical Surface("rock") = { 1 };
Physical Surface("dam") = { 2 };
Physical Curve("bottom") = { 1 };
Physical Curve("sides") = { 2, 6 };
Physical Curve("water") = { 9 };
Physical Point("crest") = { 8 };
