% [R, dR, Q] = HB_residual(X, system, H, N, analysis_type, ...)
%
% In place of NLvib's function of this name in the tests: the balance of the linear structure, in the same arguments, unknowns and
% results, without its nonlinear elements. X = [x; Omega] for 'frf'; X = [x; Omega; damping ratio; log10 amplitude] for 'nma', whose
% last two equations, the normalisation, are left at zero here.
function [R, dR, Q] = HB_residual(X, system, H, N, analysis_type, varargin)
    if ~isempty(system.nonlinear_elements)
        error('the stand-in of NLvib has no elements of its own');
    end
    n = size(system.M, 1);
    m = n*(2*H + 1);
    x = X(1:m);
    frf = strcmpi(analysis_type, 'frf');
    Omega = X(m+1);
    damping = system.D;
    scale = 1;
    if ~frf
        damping = damping - 2*Omega*X(m+2)*system.M;
        if numel(varargin) > 1 && ~isempty(varargin{2})
            scale = varargin{2};
        end
    end

    % Derivatives of [c0; cos1; sin1; ...] with respect to the phase.
    rates = zeros(2*H + 1);
    for k = 1:H
        rates(2*k, 2*k+1) = k;
        rates(2*k+1, 2*k) = -k;
    end
    inertia = kron(rates^2, system.M);
    dashpots = kron(rates, damping);
    dynamic = Omega^2*inertia + Omega*dashpots + kron(eye(2*H + 1), system.K);
    R = dynamic*x;
    dR = [dynamic, (2*Omega*inertia + dashpots)*x];
    if frf
        R(n+1:2*n) = R(n+1:2*n) - system.Fex1;
    else
        dR(:,end) = dR(:,end) - Omega*kron(rates, 2*X(m+2)*system.M)*x;
        dR = [dR, -2*Omega^2*kron(rates, system.M)*x, zeros(m, 1)]/scale;
        R = [R/scale; 0; 0];
        dR = [dR; zeros(2, m + 3)];
    end
    pairs = reshape(x(n+1:end), n, 2, H);
    Q = [x(1:n); reshape(pairs(:,1,:) - 1i*pairs(:,2,:), [], 1)];
    if ~frf
        Q = 10^X(end)*Q;
    end
end
