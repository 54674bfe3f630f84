// Rock with two joint sets and a tunnel.
SetFactory("OpenCASCADE");
Rectangle(1) = { -10, -10, 0, 20, 20 };
Disk(2) = { 0, 0, 0, 3 };
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
spacing = 3;                               // m, of the joints
joints() = {};
For set In { 0 : 1 }
  a = (set == 0 ? 65 : 155)*Pi/180;        // dip of the set
  For k In { -6 : 6 }
    x = k*spacing/Sin(a) + 0.7;
    p = newp;
    Point(p)     = { x - 40*Cos(a), -40*Sin(a), 0 };
    Point(p + 1) = { x + 40*Cos(a),  40*Sin(a), 0 };
    l = newl;
    Line(l) = { p, p + 1 };
    joints() += { l };
  EndFor
EndFor
BooleanFragments{ Surface{3}; Delete; }{ Line{joints()}; Delete; }
pieces() = Surface{:};
For k In { 0 : #pieces() - 1 }
  Physical Surface(Sprintf("b%g", k)) = { pieces(k) };
EndFor
Physical Curve("left")   = { Curve In BoundingBox { -10.01, -10.01, -1, -9.99, 10.01, 1 } };
Physical Curve("right")  = { Curve In BoundingBox { 9.99, -10.01, -1, 10.01, 10.01, 1 } };
Physical Curve("bottom") = { Curve In BoundingBox { -10.01, -10.01, -1, 10.01, -9.99, 1 } };
Physical Curve("top")    = { Curve In BoundingBox { -10.01, 9.99, -1, 10.01, 10.01, 1 } };
Mesh.MeshSizeMax = 1.5;
