SetFactory("OpenCASCADE");
Disk(1) = { 0, 0, 0, 1 };
Point(10) = { 0, -1, 0 };  Point(11) = { 0, 1, 0 };
Point(12) = { -1, 0, 0 };  Point(13) = { 1, 0, 0 };
Line(10) = { 10, 11 };     Line(11) = { 12, 13 };
BooleanFragments{ Surface{1}; Delete; }{ Line{10, 11}; Delete; }
Physical Surface("disc") = Surface{:};
Mesh.MeshSizeMax = 0.1;
