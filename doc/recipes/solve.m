T = dlmread("K.mtx", " ", 2, 0);
F = dlmread("K.mtx.rhs", " ", 2, 0);
K = sparse(T(:,1), T(:,2), T(:,3));
K = K + tril(K, -1)';
D = reshape(K \ F, 6, [])';          % a row for each element
E = dlmread("beam/elements.csv", ",", 1, 0)(:,5:7);
disp(max(max(abs(D(:,1:3) - E))) < 1e-8*max(abs(E(:))))
